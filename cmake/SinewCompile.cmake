# How hard a target is optimised, which system headers it reads precompiled, how many sources are compiled at once.
#
# Element kernels, factorisations and solvers are worth -O3; the rest is compiled to be built quickly. Tests come with
# -O1: what they time is nothing. All levels share one -march, so that vectors have one size everywhere.
#
# sinew_optimise(<target> <level>): -O<level> in release builds, in place of -O3.
function(sinew_optimise target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}>)
endfunction()

# sinew_unite(<target> <count>): so many sources are one translation unit, since most of a compiler's time goes into
# headers: ours, and the templates of the precompiled ones, which each unit instantiates anew.
function(sinew_unite target count)
  if(SINEW_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${count})
    # A source within another one counts as a header, where types of an unnamed namespace are suspect.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# A precompiled header serves targets with the same flags: -fPIC or -fPIE, and one level.
set(sinew_standard_headers <algorithm> <array> <chrono> <cmath> <filesystem> <functional> <map> <memory> <optional>
    <span> <string> <variant> <vector>)

function(_sinew_precompiled_options target level)
  target_link_libraries(${target} PRIVATE sinew_options Eigen3::Eigen fmt::fmt Threads::Threads)
  target_compile_definitions(${target} PRIVATE EIGEN_MAX_ALIGN_BYTES=64)
  sinew_optimise(${target} ${level})
endfunction()

if(SINEW_PCH)
  foreach(level 2 3)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/library.cpp CONTENT "")
    add_library(sinew_precompiled_${level} OBJECT ${CMAKE_BINARY_DIR}/precompiled/library.cpp)
    _sinew_precompiled_options(sinew_precompiled_${level} ${level})
    target_precompile_headers(sinew_precompiled_${level} PRIVATE ${sinew_standard_headers} <Eigen/Dense> <fmt/format.h>)
  endforeach()

  if(SINEW_TESTS)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/test.cpp CONTENT "int main() {}\n")
    add_executable(sinew_precompiled_test ${CMAKE_BINARY_DIR}/precompiled/test.cpp)
    _sinew_precompiled_options(sinew_precompiled_test 1)
    target_link_libraries(sinew_precompiled_test PRIVATE GTest::gmock)
    target_precompile_headers(sinew_precompiled_test PRIVATE
      ${sinew_standard_headers} <Eigen/Dense> <gmock/gmock.h> <gtest/gtest.h>)
    set_target_properties(sinew_precompiled_test PROPERTIES
                          RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/precompiled)
  endif()
endif()

# Of a target: its level, so many sources at once, and the target whose precompiled header it reads.
function(_sinew_build target level count precompiled)
  sinew_optimise(${target} ${level})
  sinew_unite(${target} ${count})
  if(SINEW_PCH)
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
endfunction()

# sinew_build_library(<target> <level>), sinew_build_test(<target>): a level, and the precompiled header for it.
function(sinew_build_library target level)
  _sinew_build(${target} ${level} 10 sinew_precompiled_${level})
endfunction()

function(sinew_build_test target)
  _sinew_build(${target} 1 6 sinew_precompiled_test)
endfunction()

# sinew_build_consumer(<target> <header>...): level 2, and a precompiled header of its own.
function(sinew_build_consumer target)
  sinew_optimise(${target} 2)
  sinew_unite(${target} 6)
  if(SINEW_PCH)
    target_precompile_headers(${target} PRIVATE ${sinew_standard_headers} <Eigen/Dense> <fmt/format.h> ${ARGN})
  endif()
endfunction()
