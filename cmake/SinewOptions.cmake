# Language level, instruction set, warnings and sanitizers, which are the same for every target of the project.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Programs export no symbols. Otherwise their copies of Eigen's inline functions, compiled for other vector registers and
# another alignment, would replace those inside Debian's libceres.so.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, Debug or RelWithDebInfo" FORCE)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)

add_library(sinew_options INTERFACE)
target_compile_options(sinew_options INTERFACE -Wall -Wextra -Wconversion -Wshadow
                       -fno-math-errno -fno-trapping-math
                       # Members that designated initializers do not name have their defaults.
                       -Wno-missing-field-initializers)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # Depending on the instruction set, GCC 12 warns about branches of Eigen, of its own intrinsics and of
  # std::string that are never reached (GCC bugs 105593, 106247, 105651). The sanitizers and clang-tidy
  # find such errors in branches that are.
  target_compile_options(sinew_options INTERFACE
                         -Wno-psabi  # wide vectors are only passed within inlined code
                         -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread
                         -Wno-maybe-uninitialized -Wno-uninitialized -Wno-restrict)
endif()
if(SINEW_WERROR)
  target_compile_options(sinew_options INTERFACE -Werror)
endif()
if(SINEW_NATIVE AND CMAKE_SYSTEM_PROCESSOR STREQUAL CMAKE_HOST_SYSTEM_PROCESSOR)
  target_compile_options(sinew_options INTERFACE -march=native)
elseif(CMAKE_SYSTEM_PROCESSOR STREQUAL x86_64)
  target_compile_options(sinew_options INTERFACE -march=x86-64-v2)
endif()
if(SINEW_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "SINEW_FUZZ needs clang: cmake --preset fuzz")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)  # instruments the libraries for the fuzz targets
endif()
if(SINEW_SANITIZE)
  add_compile_options(-fsanitize=${SINEW_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SINEW_SANITIZE})
endif()
