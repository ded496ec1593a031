# onmesh_folder(NAME [USES folder...] [DEPENDS target...] SOURCES file... [CGAL file...]
#               [PUBLIC_HEADERS header...])
#
# Compile the sources of lib/onmesh/NAME as a part of the library `onmesh`, called from that folder.
# USES names the folders that they may include headers of, beside NAME itself and `base`; it is noted
# in the build folder's `folder_uses.txt`, which the test "includes go one way" reads.
# DEPENDS are libraries that the sources include headers of.
# CGAL are sources that include CGAL, which adds -frounding-math to whatever links it and takes 20 s
# a file: they are compiled apart.
# PUBLIC_HEADERS are installed and must compile by themselves without DEPENDS; all others are
# private. They are noted in the build folder's `public_headers.txt`, for the tests.

set_property(GLOBAL PROPERTY ONMESH_FOLDERS "")
set_property(GLOBAL PROPERTY ONMESH_PUBLIC_HEADERS "")
file(WRITE ${PROJECT_BINARY_DIR}/folder_uses.txt "")

function(onmesh_folder name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;DEPENDS;SOURCES;CGAL;PUBLIC_HEADERS")
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "onmesh_folder(${name}): unknown argument ${arg_UNPARSED_ARGUMENTS}")
  endif()
  get_property(lower GLOBAL PROPERTY ONMESH_FOLDERS)
  foreach(used IN LISTS arg_USES)
    if(NOT used IN_LIST lower)
      message(FATAL_ERROR "onmesh_folder(${name}): uses ${used}, which is not a folder below it")
    endif()
  endforeach()
  set_property(GLOBAL APPEND PROPERTY ONMESH_FOLDERS ${name})
  list(JOIN arg_USES " " uses)
  file(APPEND ${PROJECT_BINARY_DIR}/folder_uses.txt "${name}: ${uses}\n")

  if(arg_SOURCES)
    onmesh_objects(onmesh_${name} ${arg_SOURCES})
    target_link_libraries(onmesh_${name} PRIVATE ${arg_DEPENDS})
    target_precompile_headers(onmesh_${name} REUSE_FROM onmesh_precompiled)
  endif()
  if(arg_CGAL)
    onmesh_objects(onmesh_${name}_cgal ${arg_CGAL})
    set_target_properties(onmesh_${name}_cgal PROPERTIES UNITY_BUILD OFF)  # one file each
    target_link_libraries(onmesh_${name}_cgal PRIVATE CGAL::CGAL ${arg_DEPENDS})
  endif()
  list(TRANSFORM arg_PUBLIC_HEADERS PREPEND onmesh/${name}/)
  set_property(GLOBAL APPEND PROPERTY ONMESH_PUBLIC_HEADERS ${arg_PUBLIC_HEADERS})
  list(TRANSFORM arg_PUBLIC_HEADERS PREPEND ${PROJECT_SOURCE_DIR}/lib/)
  target_sources(onmesh PUBLIC FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR}/lib
    FILES ${arg_PUBLIC_HEADERS})
endfunction()

# The headers of the standard library and Eigen, precompiled once for all folders, in a target without
# DEPENDS: what these define on the command line would have to be defined wherever they are reused.
function(onmesh_precompile_headers)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cpp CONTENT "")
  onmesh_objects(onmesh_precompiled ${PROJECT_BINARY_DIR}/precompiled.cpp)
  target_precompile_headers(onmesh_precompiled PRIVATE ${onmesh_common_headers})
endfunction()

# Objects of the library. Position-independent, so that shared libraries and language modules can
# link it.
function(onmesh_objects target)
  add_library(${target} OBJECT ${ARGN})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/lib)
  target_link_libraries(${target} PRIVATE onmesh_warnings Eigen3::Eigen)
  target_sources(onmesh PRIVATE $<TARGET_OBJECTS:${target}>)

  # With CMAKE_UNITY_BUILD the files of a target are compiled as one, except those that include Highway,
  # which compiles them once for each instruction set.
  foreach(source IN LISTS ARGN)
    file(STRINGS ${source} by_highway REGEX "#include <hwy/")
    if(by_highway)
      set_source_files_properties(${source} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
  endforeach()
endfunction()
