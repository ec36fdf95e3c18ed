# Read by CTest when it starts, never at configure.

# pleinair_add_suites(PROGRAM TARGET PREFIX LABEL TIMEOUT): a CTest test "PREFIX.Suite" for each
# suite that the GoogleTest executable PROGRAM lists.
function(pleinair_add_suites program target prefix label timeout)
  if(NOT EXISTS "${program}")
    add_test(${target}_NOT_BUILT ${target}_NOT_BUILT)  # as gtest_discover_tests: fails, by name
    set_tests_properties(${target}_NOT_BUILT PROPERTIES LABELS ${label})
    return()
  endif()
  execute_process(COMMAND "${program}" --gtest_list_tests TIMEOUT 30
    OUTPUT_VARIABLE listing RESULT_VARIABLE status)
  string(REGEX MATCHALL "\n[A-Za-z0-9_/]+\\." suites "\n${listing}")
  if(NOT status EQUAL 0 OR NOT suites)
    message(FATAL_ERROR "${program} cannot list its tests (${status}): ${listing}")
  endif()
  foreach(suite IN LISTS suites)
    string(REGEX REPLACE "\n(.*)\\." "\\1" suite "${suite}")
    if(NOT suite MATCHES "DISABLED_")
      add_test(${prefix}.${suite} "${program}" "--gtest_filter=${suite}.*")
      # tests/support/test_environment.cpp says this when no case of the suite could run.
      set_tests_properties(${prefix}.${suite} PROPERTIES
        LABELS ${label} TIMEOUT ${timeout} SKIP_REGULAR_EXPRESSION "every test was skipped")
    endif()
  endforeach()
endfunction()
