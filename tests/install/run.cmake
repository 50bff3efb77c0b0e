# Installs the build into a fresh prefix, builds the outside project against it and runs it.
set(root ${SINEW_BINARY_DIR}/tests/install)
file(REMOVE_RECURSE ${root})

function(step)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    list(JOIN ARGV " " command)
    message(FATAL_ERROR "${command}\nended with ${status}\n${output}")
  endif()
endfunction()

set(flags "")
if(SANITIZE)
  set(flags "-fsanitize=${SANITIZE}")
endif()
step(${CMAKE_COMMAND} --install ${SINEW_BINARY_DIR} --prefix ${root}/prefix)
# The installed tree must stand alone: it is used from another place than it was installed to.
file(RENAME ${root}/prefix ${root}/moved)
step(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${root}/build -G ${GENERATOR}
     -D CMAKE_PREFIX_PATH=${root}/moved -D CMAKE_CXX_COMPILER=${CXX_COMPILER}
     -D CMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER}
     -D CMAKE_CXX_FLAGS=${flags} -D CMAKE_BUILD_TYPE=Release -D WANTED_VERSION=${SINEW_VERSION})
step(${CMAKE_COMMAND} --build ${root}/build)
step(${root}/build/outside)
step(${root}/build/outside_plain)
if(EXISTS ${root}/moved/bin/sinew)
  step(${root}/moved/bin/sinew --version)
endif()
