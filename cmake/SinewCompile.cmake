# Optimisation level, precompiled headers, and unity builds of targets.
#
# Element kernels, factorisations and solvers need -O3; everything else is compiled to build quickly. Tests use -O1,
# because they measure no time. All levels share one -march, so vectors have one size everywhere.
#
# sinew_optimise(<target> <level>): -O<level> in release builds, instead of -O3.
function(sinew_optimise target level)
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O${level}>)
endfunction()

# sinew_unite(<target> <count>): combines this number of sources into one translation unit, because most of the compile
# time goes into headers: ours, and the templates of the precompiled ones, which each unit instantiates again.
function(sinew_unite target count)
  if(SINEW_UNITY)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${count})
    # The compiler treats an included source as a header, in which it warns about types of an unnamed namespace.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# A precompiled header can be shared by targets with the same flags: -fPIC or -fPIE, and the optimisation level.
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

# Sets the level of a target, the number of sources per unit, and the target whose precompiled header it reuses.
function(_sinew_build target level count precompiled)
  sinew_optimise(${target} ${level})
  sinew_unite(${target} ${count})
  if(SINEW_PCH)
    target_precompile_headers(${target} REUSE_FROM ${precompiled})
  endif()
endfunction()

# sinew_build_library(<target> <level>), sinew_build_test(<target>): sets a level and reuses the precompiled header for it.
function(sinew_build_library target level)
  _sinew_build(${target} ${level} 10 sinew_precompiled_${level})
endfunction()

function(sinew_build_test target)
  _sinew_build(${target} 1 6 sinew_precompiled_test)
endfunction()

# sinew_build_consumer(<target> <header>...): sets level 2 and creates a precompiled header for the target.
function(sinew_build_consumer target)
  sinew_optimise(${target} 2)
  sinew_unite(${target} 6)
  if(SINEW_PCH)
    target_precompile_headers(${target} PRIVATE ${sinew_standard_headers} <Eigen/Dense> <fmt/format.h> ${ARGN})
  endif()
endfunction()
