# Finds system libraries without a CMake package, and makes them imported targets SinewSystem::<name>.
# The build uses it, and so does every project that links Sinew: it is installed beside sinewConfig.cmake.
include_guard(GLOBAL)

# sinew_system_library(<name> LIBRARY lib HEADER header [SUFFIXES dir...] [OPTIONAL])
function(sinew_system_library name)
  cmake_parse_arguments(arg "OPTIONAL" "LIBRARY;HEADER" "SUFFIXES" ${ARGN})
  if(TARGET SinewSystem::${name})
    return()
  endif()
  string(TOUPPER SINEW_${name} variable)
  find_library(${variable}_LIBRARY ${arg_LIBRARY} PATH_SUFFIXES ${arg_SUFFIXES})
  find_path(${variable}_INCLUDE ${arg_HEADER} PATH_SUFFIXES ${arg_SUFFIXES})
  mark_as_advanced(${variable}_LIBRARY ${variable}_INCLUDE)
  if(NOT ${variable}_LIBRARY OR NOT ${variable}_INCLUDE)
    if(arg_OPTIONAL)
      return()
    endif()
    message(FATAL_ERROR "Sinew needs ${arg_LIBRARY} with its header ${arg_HEADER}, which were not found. "
                        "On Debian, `scripts/setup.sh build` installs all that Sinew needs; elsewhere set "
                        "${variable}_LIBRARY and ${variable}_INCLUDE.")
  endif()
  add_library(SinewSystem::${name} UNKNOWN IMPORTED GLOBAL)
  set_target_properties(SinewSystem::${name} PROPERTIES
    IMPORTED_LOCATION ${${variable}_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${${variable}_INCLUDE}
    INTERFACE_SYSTEM_INCLUDE_DIRECTORIES ${${variable}_INCLUDE})
endfunction()

sinew_system_library(metis LIBRARY metis HEADER metis.h)
sinew_system_library(amd LIBRARY amd HEADER amd.h SUFFIXES suitesparse)
sinew_system_library(hdf5 LIBRARY hdf5 HEADER hdf5.h SUFFIXES hdf5/serial)

# Uses the shared libceres, not the static one of its CMake package. The static one has weak copies of Eigen's
# functions for 16-byte alignment, which the linker may choose instead of ours for 64 bytes. Memory would then be
# freed in another way than it was allocated.
function(sinew_ceres)
  sinew_system_library(ceres LIBRARY ${CMAKE_SHARED_LIBRARY_PREFIX}ceres${CMAKE_SHARED_LIBRARY_SUFFIX}
                       HEADER ceres/ceres.h)
  sinew_system_library(glog LIBRARY glog HEADER glog/logging.h)
  target_link_libraries(SinewSystem::ceres INTERFACE SinewSystem::glog)
endfunction()
