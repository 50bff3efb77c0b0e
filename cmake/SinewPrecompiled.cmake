# Eigen and GoogleTest are read once, not once a source. There are two precompiled headers, because
# libraries are compiled with -fPIC and programs with -fPIE; a target adopts one of them.
set(sinew_standard_headers <array> <cmath> <memory> <span> <string> <vector>)

function(sinew_adopt_precompiled target)
  if(SINEW_PCH)
    target_precompile_headers(${target} REUSE_FROM sinew_precompiled)
  endif()
endfunction()

function(sinew_adopt_precompiled_test target)
  if(SINEW_PCH)
    target_precompile_headers(${target} REUSE_FROM sinew_precompiled_test)
  endif()
endfunction()

if(SINEW_PCH)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/library.cpp CONTENT "")
  add_library(sinew_precompiled OBJECT ${CMAKE_BINARY_DIR}/precompiled/library.cpp)
  target_link_libraries(sinew_precompiled PRIVATE sinew_options Eigen3::Eigen fmt::fmt Threads::Threads)
  target_compile_definitions(sinew_precompiled PRIVATE EIGEN_MAX_ALIGN_BYTES=64)
  target_precompile_headers(sinew_precompiled PRIVATE ${sinew_standard_headers} <Eigen/Dense>)

  if(SINEW_TESTS)
    file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled/test.cpp CONTENT "int main() {}\n")
    add_executable(sinew_precompiled_test ${CMAKE_BINARY_DIR}/precompiled/test.cpp)
    target_link_libraries(sinew_precompiled_test PRIVATE
                          sinew_options Eigen3::Eigen fmt::fmt Threads::Threads GTest::gmock)
    target_compile_definitions(sinew_precompiled_test PRIVATE EIGEN_MAX_ALIGN_BYTES=64)
    target_precompile_headers(sinew_precompiled_test PRIVATE
      ${sinew_standard_headers} <Eigen/Dense> <gmock/gmock.h> <gtest/gtest.h>)
    set_target_properties(sinew_precompiled_test PROPERTIES
                          RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/precompiled)
  endif()
endif()
