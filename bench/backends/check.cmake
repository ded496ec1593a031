# Runs PROGRAM --quick with its files in WORK and checks that they are complete: every back end has a
# row per mesh, and every row has the numbers it should have.
# cmake -DPROGRAM=... -DWORK=... -P check.cmake

cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../check_plots.cmake)

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(
  COMMAND ${PROGRAM} --quick --csv ${WORK}/rows.csv --markdown ${WORK}/tables.md
  COMMAND_ERROR_IS_FATAL ANY)

file(STRINGS ${WORK}/rows.csv rows)
list(POP_FRONT rows header)
set(number "-?[0-9][0-9.]*(e[-+][0-9]+)?")
# mesh, backend, 17 numbers that all have; 4 more of time and memory; why it was skipped.
if(NOT header MATCHES "^mesh,backend(,[a-z0-9_]+)+,refine_ms,us_per_source,prepare_us,memory_mb,skipped$")
  message(FATAL_ERROR "unexpected columns: ${header}")
endif()
foreach(mesh cube book)
  foreach(backend exact unfold heat cloud Euclidean)
    set(found ${rows})
    list(FILTER found INCLUDE REGEX "^${mesh},${backend},")
    list(LENGTH found count)
    if(NOT count EQUAL 1)
      message(FATAL_ERROR "${count} rows for ${backend} on the ${mesh}")
    endif()
    string(REPLACE "," ";" fields "${found}")
    list(LENGTH fields length)
    if(NOT length EQUAL 24)
      message(FATAL_ERROR "${length} fields: ${found}")
    endif()
    set(last 18)
    if(backend MATCHES "^(unfold|heat|cloud)$")
      set(last 22)
    endif()
    foreach(i RANGE 2 ${last})
      list(GET fields ${i} field)
      if(NOT field MATCHES "^${number}$")
        message(FATAL_ERROR "field ${i} is '${field}', no finite number: ${found}")
      endif()
    endforeach()
  endforeach()
endforeach()

# Two meshes and the legend; all five back ends have errors and PSNR, three have times.
check_plots(backends ${WORK}/rows.csv
  backend-errors.svg 15 backend-psnr.svg 15 backend-times.svg 9)
file(READ ${WORK}/tables.md tables)
if(NOT tables MATCHES "\n[|] cube [|].*\n[|] unfold [|]")
  message(FATAL_ERROR "tables.md lacks its tables")
endif()
