# What the checks of the benchmarks' programs share.

# Draws plots of one kind into the CSV file's folder and checks that every picture has as many markers
# as there are numbers, and one per name in its legend:
# check_plots(KIND file.csv picture.svg markers [picture.svg markers]...).
# Without gnuplot it says so, and so must bench/make_plots.
function(check_plots kind csv)
  set(make_plots ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/make_plots)
  cmake_path(GET csv PARENT_PATH folder)
  find_program(bash bash REQUIRED)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env PATH=${folder} ${bash} ${make_plots} ${kind} ${csv} ${folder}
    RESULT_VARIABLE code ERROR_VARIABLE error)
  if(NOT code EQUAL 1 OR NOT error STREQUAL
      "make_plots: gnuplot is missing: install gnuplot-nox\n")
    message(FATAL_ERROR "without gnuplot: exit code ${code}, ${error}")
  endif()
  find_program(gnuplot gnuplot)
  if(NOT gnuplot)
    message(STATUS "no plots are checked: gnuplot is missing, install gnuplot-nox")
    return()
  endif()

  execute_process(COMMAND ${make_plots} ${kind} ${csv} ${folder} COMMAND_ERROR_IS_FATAL ANY)
  while(ARGN)
    list(POP_FRONT ARGN picture expected)
    file(READ ${folder}/${picture} plot)
    string(REGEX MATCHALL "<use [^>]*#gpPt[0-9]+' transform=" markers "${plot}")
    list(LENGTH markers count)
    if(NOT count EQUAL expected OR plot MATCHES "[ >,]-?(nan|inf)[ <,]")
      message(FATAL_ERROR "${picture} has ${count} markers instead of ${expected}, or no numbers")
    endif()
  endwhile()
endfunction()
