# Runs small benchmarks of the whole filter with BENCH, turns them into tables and plots with TABLES
# and bench/make_plots, with files in WORK, and checks that all numbers are there.
# cmake -DBENCH=... -DTABLES=... -DMESH=... -DWORK=... -P check.cmake

cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../check_plots.cmake)

file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})
execute_process(
  COMMAND ${BENCH} --quick --mesh=${MESH}
    --benchmark_filter=^\(texels|sigma|threads|mesh_size|file\)/
    --benchmark_out=${WORK}/scaling.json --benchmark_out_format=json
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${WORK}/README.md
  "before\n<!-- scaling: begin -->\nold\n<!-- scaling: end -->\nafter\n")
execute_process(
  COMMAND ${TABLES} ${WORK}/scaling.json --markdown ${WORK}/tables.md --csv ${WORK}/scaling.csv
    --readme ${WORK}/README.md
  COMMAND_ERROR_IS_FATAL ANY)

# Every row of these tables has a time per method that is more than nothing.
set(time "(0[.][0-9]*[1-9][0-9]*|[1-9][0-9.]*)( [(][0-9.]+[)])?")
set(two_methods "${time} [|] ${time} [|]")
set(three_methods "${two_methods} ${time} [|]")
set(texture "128 x 128")
set(large_texture "256 x 256")
file(READ ${WORK}/tables.md tables)
foreach(row
    "${texture} [|] [0-9]+ [|] ${three_methods}"
    "${large_texture} [|] [0-9]+ [|] ${three_methods}"
    "${large_texture} [|] 4 [|] [0-9]+ [|] ${three_methods}"
    "${large_texture} [|] 1 [|] [0-9]+ [|] ${two_methods}"
    "sheet [|] 98 [|] [0-9]+ [|] ${two_methods}"
    "sphere [|] 20 [|] [0-9]+ [|] ${two_methods}"
    "sphere [|] ${large_texture} [|] 8 [|] [0-9]+ [|] ${three_methods}")
  if(NOT tables MATCHES "\n[|] ${row} ")
    message(FATAL_ERROR "no row '${row}' in tables.md:\n${tables}")
  endif()
endforeach()
# The stages of one benchmark, megatexels per second, nodes, share by nodes.
set(number "[0-9][0-9.,]*")
if(NOT tables MATCHES
    "\n[|] texels, size 256, nodes [|]( ${number} [|])( ${number} [|])( ${number} [|])( ${number} [|])( ${number} [|])( ${number} [|])( ${number} [|]) ${number} [|]")
  message(FATAL_ERROR "tables.md lacks the stages of a benchmark:\n${tables}")
endif()

file(READ ${WORK}/README.md readme)
if(NOT readme MATCHES "^before\n<!-- scaling: begin -->\n.*\n[|] ${texture} .*\n<!-- scaling: end -->\nafter\n$"
   OR readme MATCHES "\nold\n")
  message(FATAL_ERROR "the tables are not where they should be:\n${readme}")
endif()

# Every line of the CSV file is a point of a plot, every series in it a name in the legend.
file(STRINGS ${WORK}/scaling.csv rows)
set(pictures)
foreach(family texels sigma threads mesh_size)
  set(of_family ${rows})
  list(FILTER of_family INCLUDE REGEX "^${family},[^,]+,[^,]+,[0-9]+,[0-9.e-]+$")
  list(LENGTH of_family points)
  if(points LESS 2)
    message(FATAL_ERROR "scaling.csv has ${points} times by ${family}")
  endif()
  list(TRANSFORM of_family REPLACE "^[^,]+,[^,]+,([^,]+),.*" "\\1" OUTPUT_VARIABLE series)
  list(REMOVE_DUPLICATES series)
  list(LENGTH series names)
  math(EXPR markers "${points} + ${names}")
  list(APPEND pictures scaling-${family}.svg ${markers})
endforeach()
check_plots(scaling ${WORK}/scaling.csv ${pictures})

# What it cannot read or write is said, and nothing is changed.
file(WRITE ${WORK}/plain.md "no markers\n")
foreach(arguments "${WORK}/plain.md" "${WORK}/scaling.json;--readme;${WORK}/plain.md")
  execute_process(COMMAND ${TABLES} ${arguments} RESULT_VARIABLE code ERROR_VARIABLE error)
  if(NOT code EQUAL 3 OR NOT error MATCHES "^onmesh_bench_tables: ")
    message(FATAL_ERROR "${arguments}: exit code ${code}, ${error}")
  endif()
endforeach()
file(READ ${WORK}/plain.md plain)
if(NOT plain STREQUAL "no markers\n")
  message(FATAL_ERROR "a README without markers was changed")
endif()
