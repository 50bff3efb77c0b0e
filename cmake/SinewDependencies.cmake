# Everything here is a Debian package; scripts/setup.sh installs them.
# What the installed library still needs when others link it is found again by sinewConfig.cmake.in.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(fmt REQUIRED)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(ZLIB REQUIRED)
find_package(assimp REQUIRED)
find_package(pugixml REQUIRED)
find_package(CLI11 REQUIRED)
include(SinewSystemLibraries)

if(SINEW_IDENTIFY)
  find_package(Ceres 2.1 REQUIRED)
endif()
if(SINEW_VIEWER)
  find_package(Boost 1.74 REQUIRED)  # headers alone: Beast and Asio
endif()

if(SINEW_TESTS)
  find_package(GTest REQUIRED)
endif()
if(SINEW_BENCHMARKS)
  find_package(benchmark REQUIRED)
endif()
if(SINEW_TESTS OR SINEW_BENCHMARKS)
  # An independent oracle. It holds GPL modules, so the library itself never links it.
  sinew_system_library(cholmod LIBRARY cholmod HEADER cholmod.h SUFFIXES suitesparse OPTIONAL)
endif()
if(SINEW_PYTHON)
  # Debian's own interpreter is the one that has Debian's NumPy, whatever python3 stands first on PATH.
  if(NOT Python3_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python3_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Interpreter that the package is built for")
  endif()
  find_package(Python3 3.9 REQUIRED COMPONENTS Interpreter Development.Module)
  find_package(pybind11 2.10 REQUIRED)
endif()
