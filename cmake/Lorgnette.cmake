# Settings that every target shares, and lorgnette_module(): one folder, one library, its tests.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O2 -DNDEBUG")
# Eigen's and the standard library's asserts stay on while developing.
set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1 -D_GLIBCXX_ASSERTIONS")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}")

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
  if(LORGNETTE_PCH)
    # Paths below the root count as relative, so that a fresh clone elsewhere finds the same objects;
    # the looseness is what ccache asks for precompiled headers.
    list(PREPEND CMAKE_CXX_COMPILER_LAUNCHER
         "${CMAKE_COMMAND}" -E env "CCACHE_BASEDIR=${PROJECT_SOURCE_DIR}" CCACHE_NOHASHDIR=1
         CCACHE_SLOPPINESS=pch_defines,time_macros)
  endif()
endif()

option(LORGNETTE_WERROR "Warnings are errors; off with sanitizers, whose checks mislead GCC 12" ON)
add_library(lorgnette_options INTERFACE)
target_compile_options(lorgnette_options INTERFACE -Wall -Wextra -Wshadow -Wnon-virtual-dtor
                                                  -Woverloaded-virtual)
if(LORGNETTE_WERROR)
  target_compile_options(lorgnette_options INTERFACE -Werror)
endif()
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Of an empty std::optional that is moved GCC says that its value may be uninitialised (its bug
  # 80635), and in joined sources it sees more of them.
  target_compile_options(lorgnette_options INTERFACE -Wno-maybe-uninitialized)
endif()
target_include_directories(lorgnette_options INTERFACE "${PROJECT_SOURCE_DIR}")

# Highway compiles a kernel once a target. SSSE3 alone is found in no machine that traces often;
# under the sanitizers one target stands for all, since they share their source. Definition for the
# sources of kernels, their tests and benchmarks.
set(LORGNETTE_HIGHWAY "HWY_DISABLED_TARGETS=HWY_SSSE3")
if(CMAKE_CXX_FLAGS MATCHES "-fsanitize")
  set(LORGNETTE_HIGHWAY
      "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
endif()

# Tests are compiled more often than they run: a third of their time goes at -O2.
add_library(lorgnette_test_options INTERFACE)
target_link_libraries(lorgnette_test_options INTERFACE lorgnette_options)
target_compile_options(lorgnette_test_options INTERFACE $<$<CONFIG:Release>:-O1>)

# For whoever includes "cmake/source_dir.h".
configure_file("${PROJECT_SOURCE_DIR}/cmake/source_dir.h.in"
               "${PROJECT_BINARY_DIR}/generated/cmake/source_dir.h" @ONLY)
add_library(lorgnette_source_dir INTERFACE)
target_include_directories(lorgnette_source_dir INTERFACE "${PROJECT_BINARY_DIR}/generated")

# Headers that most sources read, compiled once: for the libraries and for the tests. A source names
# its includes all the same, and scripts/check compiles it without.
if(LORGNETTE_PCH)
  # GCC 12 finds overlapping copies in its own std::string (its bug 105651), and says so of headers
  # that were precompiled.
  target_compile_options(lorgnette_options INTERFACE -Wno-restrict)
  find_package(Eigen3 REQUIRED)
  find_package(fmt REQUIRED)
  file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/precompiled.cc" CONTENT "")  # keeps an old one
  set(LORGNETTE_PCH_HEADERS <algorithm> <cmath> <functional> <memory> <optional> <string> <vector>
                            <Eigen/Geometry> <fmt/format.h> <tl/expected.hpp>)
  foreach(kind library tests)
    add_library(lorgnette_pch_${kind} OBJECT "${PROJECT_BINARY_DIR}/precompiled.cc")
    target_link_libraries(lorgnette_pch_${kind} PRIVATE Eigen3::Eigen fmt::fmt lorgnette_options)
    target_precompile_headers(lorgnette_pch_${kind} PRIVATE ${LORGNETTE_PCH_HEADERS})
  endforeach()
  if(LORGNETTE_TESTS)
    target_link_libraries(lorgnette_pch_tests PRIVATE lorgnette_test_options GTest::gmock)
    target_precompile_headers(lorgnette_pch_tests PRIVATE <gmock/gmock.h> <gtest/gtest.h>)
  endif()
endif()

# lorgnette_module(NAME [PUBLIC lib...] [PRIVATE lib...])
#   library lorgnette_NAME          of NAME/*.cc
#   test program NAME_tests         of tests/NAME/*.cc, when LORGNETTE_TESTS is on
#   benchmark program NAME_bench    of bench/NAME/*.cc, when LORGNETTE_BENCH is on
function(lorgnette_module name)
  cmake_parse_arguments(ARG "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${name}/*.cc")
  add_library(lorgnette_${name} STATIC ${sources})
  target_link_libraries(lorgnette_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE}
                                                                       lorgnette_options)
  target_include_directories(lorgnette_${name} PUBLIC "${PROJECT_SOURCE_DIR}")
  if(LORGNETTE_PCH)
    target_precompile_headers(lorgnette_${name} REUSE_FROM lorgnette_pch_library)
  endif()

  file(GLOB test_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/tests/${name}/*.cc")
  if(LORGNETTE_TESTS AND test_sources)
    add_executable(${name}_tests ${test_sources})
    target_link_libraries(
      ${name}_tests PRIVATE lorgnette_${name} ${ARG_PRIVATE} lorgnette_test_options
                            lorgnette_source_dir GTest::gmock GTest::gtest_main)
    if(LORGNETTE_PCH)
      target_precompile_headers(${name}_tests REUSE_FROM lorgnette_pch_tests)
    endif()
    if(LORGNETTE_TEST_PROGRAMS)
      # In parts, for as many cores to share.
      set(parts 4)
      foreach(part RANGE 1 ${parts})
        add_test(NAME ${name}_${part} COMMAND ${name}_tests --gtest_brief=1)
        math(EXPR index "${part} - 1")
        set_tests_properties(${name}_${part} PROPERTIES ENVIRONMENT
                             "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${index}")
      endforeach()
    else()
      gtest_discover_tests(${name}_tests TEST_PREFIX "${name}." DISCOVERY_MODE PRE_TEST)
    endif()
  endif()

  file(GLOB bench_sources CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/bench/${name}/*.cc")
  if(LORGNETTE_BENCH AND bench_sources)
    add_executable(${name}_bench ${bench_sources})
    target_link_libraries(${name}_bench PRIVATE lorgnette_${name} ${ARG_PRIVATE} lorgnette_options
                                                benchmark::benchmark_main)
  endif()
endfunction()
