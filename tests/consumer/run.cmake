# Steps of the tests of the installed library:
#   install     the build at BUILD into WORK/prefix
#   cmake       build and run the consumer with the CMake package there
#   pkg-config  the same with the compiler and pkg-config alone
# cmake -DSTEP=... -DBUILD=... -DSOURCE=... -DWORK=... -DGENERATOR=... -DCONFIG=... -DCOMPILER=...
#       -P run.cmake

set(prefix ${WORK}/prefix)

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(STEP STREQUAL install)
  file(REMOVE_RECURSE ${WORK})
  run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
  if(EXISTS ${prefix}/bin/onmesh)
    run(${prefix}/bin/onmesh --version)
  endif()
elseif(STEP STREQUAL cmake)
  run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/cmake -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG}
      -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_PREFIX_PATH=${prefix})
  run(${CMAKE_COMMAND} --build ${WORK}/cmake)
  run(${WORK}/cmake/consumer)
elseif(STEP STREQUAL pkg-config)
  file(GLOB_RECURSE package ${prefix}/onmesh.pc)
  cmake_path(GET package PARENT_PATH package_folder)
  set(ENV{PKG_CONFIG_PATH} ${package_folder})
  execute_process(COMMAND pkg-config --static --cflags --libs onmesh OUTPUT_VARIABLE flags
    OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  file(MAKE_DIRECTORY ${WORK}/pkg-config)
  run(${COMPILER} -std=c++20 ${SOURCE}/main.cpp ${flags} -o ${WORK}/pkg-config/consumer)
  run(${WORK}/pkg-config/consumer)
else()
  message(FATAL_ERROR "no step '${STEP}'")
endif()
