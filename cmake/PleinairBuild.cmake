# Compilation of every module: the language standard, warnings, sanitizers, and the functions that
# declare a module's library, tests, fuzz targets and benchmarks.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set_property(GLOBAL PROPERTY USE_FOLDERS ON)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_C_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

# Programs and tests are many, and GNU ld takes 13 s of processor time to link the largest.
find_program(MOLD_PROGRAM mold)
if(MOLD_PROGRAM)
  add_link_options(-fuse-ld=mold)
endif()

find_package(Threads REQUIRED)

# Flags of this tree's code. Dependencies are SYSTEM headers, which these flags do not apply to.
add_library(pleinair_build INTERFACE)
target_include_directories(pleinair_build INTERFACE "${CMAKE_SOURCE_DIR}")
target_link_libraries(pleinair_build INTERFACE Threads::Threads)
target_compile_options(pleinair_build INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wold-style-cast -Wnon-virtual-dtor
  -Woverloaded-virtual -Wcast-qual -Wmissing-declarations
  -Wno-missing-field-initializers  # designated initialisers leave the rest at its default
  -Werror)
if(PLEINAIR_ASSERTIONS)
  # RelWithDebInfo and Release define NDEBUG; -UNDEBUG keeps assertions.
  target_compile_options(pleinair_build INTERFACE -UNDEBUG)
  target_compile_definitions(pleinair_build INTERFACE _GLIBCXX_ASSERTIONS)
endif()

if(PLEINAIR_SANITIZE)
  add_compile_options(-fsanitize=${PLEINAIR_SANITIZE} -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${PLEINAIR_SANITIZE})
  if(NOT PLEINAIR_FUZZ)  # which is to run fast
    # Instrumented code takes twice as long to compile at -O2 -g as at -O1 -g1.
    add_compile_options(-O1 -g1)
  endif()
  # With sanitizers, gcc 12 reports parts of <regex> as uninitialised.
  target_compile_options(pleinair_build INTERFACE
    $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  if(PLEINAIR_SANITIZE MATCHES "undefined")
    add_compile_options(-fno-sanitize-recover=undefined)
  endif()
endif()

if(PLEINAIR_FUZZ)
  # Instruments this tree's code for libFuzzer; each fuzz target links libFuzzer itself.
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
  add_custom_target(fuzz)
endif()

# Makes the sources that the build generates, and compiles nothing: clang-tidy needs them.
add_custom_target(generated)
function(pleinair_generates name)
  add_custom_target(${name}_generated DEPENDS ${ARGN})
  add_dependencies(generated ${name}_generated)
endfunction()

# Compiles a target's sources in batches (docs/decisions/0018-unity-builds.md), because most of the
# compiler's time goes to headers. Sources of one batch share their unnamed namespaces, so names in
# them must differ. The preset "clang" compiles each source by itself.
option(PLEINAIR_UNITY "Compile the sources of a module in batches" ON)
function(pleinair_speed_up target)
  if(PLEINAIR_UNITY)
    set_target_properties(${target} PROPERTIES
      UNITY_BUILD ON UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# pleinair_library(NAME SOURCES ... [ALONE sources ...] [PUBLIC libs ...] [PRIVATE libs ...])
# A module's static library. PUBLIC: libraries that its headers use; PRIVATE: libraries that only its
# .cpp files use. ALONE: those of SOURCES that are compiled outside the batches of PLEINAIR_UNITY,
# because names in their unnamed namespaces collide with others.
function(pleinair_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;PUBLIC;PRIVATE" ${ARGN})
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_library(${name} STATIC ${ARG_SOURCES})
  pleinair_speed_up(${name})
  target_link_libraries(${name} PUBLIC pleinair_build ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

option(PLEINAIR_ONE_PROCESS_TESTS "Run each test program in one process: where starting one is slow" OFF)

# pleinair_tests(NAME KIND kind SOURCES ... [ALONE sources ...] [LIBS ...] [TIMEOUT seconds] [QUICK] [BY_SUITE] [SERIAL])
# A GoogleTest executable of one kind (unit, conformance, gpu, golden ...). The kind is the prefix of
# its tests' names and their CTest label; QUICK makes the label "kind-quick", which `./dev test quick`
# selects. CTest runs each case in a process of its own. BY_SUITE, which gpu and golden imply, runs
# each suite in one process, which loads the GL driver and compiles its code once a suite. SERIAL
# runs no other test beside its cases, which depend on the machine's speed.
# PLEINAIR_ONE_PROCESS_TESTS makes one test "kind.NAME" of each executable.
function(pleinair_tests name)
  cmake_parse_arguments(ARG "QUICK;BY_SUITE;SERIAL" "KIND;TIMEOUT" "SOURCES;ALONE;LIBS" ${ARGN})
  set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  # It replaces operator new, which other sources of its batch would see.
  set_source_files_properties("${CMAKE_SOURCE_DIR}/tests/support/allocation_count.cpp"
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  add_executable(${name} ${ARG_SOURCES} "${CMAKE_SOURCE_DIR}/tests/support/test_environment.cpp"
    "${CMAKE_SOURCE_DIR}/tests/support/sanitizer_suppressions.cpp")
  pleinair_speed_up(${name})
  # Test code is compiled more often than it runs: this takes 42 % less time than -O2 -g, and keeps
  # line numbers. The product and the oracles keep the flags of the build type, where no sanitizer is asked for.
  target_compile_options(${name} PRIVATE -O1 -g1)
  target_link_libraries(${name} PRIVATE pleinair_build ${ARG_LIBS} GTest::gmock_main)
  target_compile_definitions(${name} PRIVATE
    PLEINAIR_SHARED_DATA="${PLEINAIR_SHARED_DATA}"
    PLEINAIR_TESTS_DIR="${CMAKE_SOURCE_DIR}/tests"
    PLEINAIR_BUILD_DIR="${CMAKE_BINARY_DIR}")
  set(label ${ARG_KIND})
  if(ARG_QUICK)
    set(label ${ARG_KIND}-quick)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(PLEINAIR_SANITIZE)
    math(EXPR ARG_TIMEOUT "10 * ${ARG_TIMEOUT}")
  endif()
  if(PLEINAIR_ONE_PROCESS_TESTS)
    math(EXPR ARG_TIMEOUT "30 * ${ARG_TIMEOUT}")  # all cases, on an emulated processor
    add_test(NAME ${ARG_KIND}.${name} COMMAND ${name})
    set_tests_properties(${ARG_KIND}.${name} PROPERTIES
      LABELS "${label}" TIMEOUT ${ARG_TIMEOUT} SKIP_REGULAR_EXPRESSION "every test was skipped")
  elseif(ARG_BY_SUITE OR ARG_KIND MATCHES "^(gpu|golden)$")
    set(list "${CMAKE_CURRENT_BINARY_DIR}/${name}_suites.cmake")
    file(GENERATE OUTPUT "${list}" CONTENT
      "include(\"${CMAKE_SOURCE_DIR}/cmake/AddSuites.cmake\")
pleinair_add_suites(\"$<TARGET_FILE:${name}>\" ${name} ${ARG_KIND} ${label} ${ARG_TIMEOUT})
")
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${list}")
  else()
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 30
      TEST_PREFIX "${ARG_KIND}." PROPERTIES LABELS "${label}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL "${ARG_SERIAL}")
  endif()
endfunction()

# pleinair_fuzz(NAME SOURCES ... [LIBS ...])
# A fuzz target: SOURCES define LLVMFuzzerTestOneInput (tests/fuzz/fuzz_target.h). In the preset
# "fuzz" it is the libFuzzer program fuzz_NAME, which the target "fuzz" builds with the others. In
# other presets it is the quick test "fuzz.NAME", which runs the inputs of tests/fuzz/corpus/NAME once.
function(pleinair_fuzz name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(fuzz_${name} ${ARG_SOURCES})
  target_link_libraries(fuzz_${name} PRIVATE pleinair_build ${ARG_LIBS})
  if(PLEINAIR_FUZZ)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    target_compile_definitions(fuzz_${name} PRIVATE PLEINAIR_FUZZ)
    add_dependencies(fuzz fuzz_${name})
  else()
    target_sources(fuzz_${name} PRIVATE "${CMAKE_SOURCE_DIR}/tests/fuzz/run_corpus.cpp")
    add_test(NAME fuzz.${name}
      COMMAND fuzz_${name} "${CMAKE_SOURCE_DIR}/tests/fuzz/corpus/${name}")
    set_tests_properties(fuzz.${name} PROPERTIES LABELS fuzz-quick TIMEOUT 60)
  endif()
endfunction()

# pleinair_benchmark(NAME SOURCES ... [LIBS ...]): a Google Benchmark executable, run by hand.
function(pleinair_benchmark name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE pleinair_build ${ARG_LIBS} benchmark::benchmark_main)
  target_compile_definitions(${name} PRIVATE PLEINAIR_SHARED_DATA="${PLEINAIR_SHARED_DATA}"
    PLEINAIR_TESTS_DIR="${CMAKE_SOURCE_DIR}/tests")
endfunction()
