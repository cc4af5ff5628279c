# cmake -DFOVEA=... -DPROGRAM=... -DFOLDER=... -P run_library_tour.cmake: takes a sample through all of the library's tour
# and looks at what it says and writes.
set(input ${FOLDER}/tour_vase.glb)
execute_process(COMMAND ${FOVEA} sample vase --detail 0.05 -o ${input} --force COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE ${FOLDER}/small.glb)
execute_process(COMMAND ${PROGRAM} ${input} ${FOLDER} OUTPUT_VARIABLE text ERROR_VARIABLE progress
  COMMAND_ERROR_IS_FATAL ANY)
message("${text}")
foreach(expected "vase: [0-9]+ triangles" "dB, FLIP 0" "bytes, [0-9]+ triangles" "bytes for all levels"
        "triangles from [0-9.]+ on, error")
  if(NOT text MATCHES "${expected}")
    message(FATAL_ERROR "the tour does not say \"${expected}\"")
  endif()
endforeach()
if(NOT EXISTS ${FOLDER}/small.glb)
  message(FATAL_ERROR "the tour wrote no small.glb")
endif()
# Who brings no model is told why.
execute_process(COMMAND ${PROGRAM} ${FOLDER}/no.glb ${FOLDER} RESULT_VARIABLE code ERROR_VARIABLE text)
if(NOT code EQUAL 3 OR NOT text MATCHES "no.glb")
  message(FATAL_ERROR "exit code ${code} for a missing file: ${text}")
endif()
