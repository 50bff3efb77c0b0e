# System libraries that come without a CMake package, as imported targets SinewSystem::<name>.
# Used by the build and, installed beside sinewConfig.cmake, by every project that links Sinew.
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

# The shared libceres, and not the static one that its own CMake package names: that one holds weak copies of
# Eigen's functions for 16-byte alignment, which the linker may choose for ours of 64 (memory is then freed as it
# was not allocated).
function(sinew_ceres)
  sinew_system_library(ceres LIBRARY ${CMAKE_SHARED_LIBRARY_PREFIX}ceres${CMAKE_SHARED_LIBRARY_SUFFIX}
                       HEADER ceres/ceres.h)
  sinew_system_library(glog LIBRARY glog HEADER glog/logging.h)
  target_link_libraries(SinewSystem::ceres INTERFACE SinewSystem::glog)
endfunction()
