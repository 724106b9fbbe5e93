# cmake -P script of the package test; stops at the first command that fails.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${work_dir})
# Installed in one place and used from another: the package must not remember where it was.
run(${CMAKE_COMMAND} --install ${build_dir} --prefix ${work_dir}/staged)
file(RENAME ${work_dir}/staged ${work_dir}/prefix)

foreach(components "tiling" "tiling matcher" "")
  string(REPLACE " " "-" name "consumer-${components}")
  run(${CMAKE_COMMAND} -S ${consumer_dir} -B ${work_dir}/${name} -G ${generator}
    -D CMAKE_PREFIX_PATH=${work_dir}/prefix -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher}
    -D COMPONENTS=${components})
  run(${CMAKE_COMMAND} --build ${work_dir}/${name})
  run(${work_dir}/${name}/consumer)
endforeach()
