# pleinair_embed_face_cascades(TARGET): embeds OpenCV's classifiers of faces into TARGET, so that the
# program needs no file of OpenCV's where it runs.
function(pleinair_embed_face_cascades target)
  set(generated "${CMAKE_BINARY_DIR}/generated/pipeline/tracking/faces/face_cascades.cpp")
  list(JOIN PLEINAIR_FACE_CASCADES "|" joined)
  add_custom_command(
    OUTPUT "${generated}"
    COMMAND "${CMAKE_COMMAND}" "-DINPUTS=${joined}" "-DOUTPUT=${generated}"
            -P "${CMAKE_SOURCE_DIR}/cmake/EmbedFaceCascades.cmake"
    DEPENDS ${PLEINAIR_FACE_CASCADES} "${CMAKE_SOURCE_DIR}/cmake/EmbedFaceCascades.cmake"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
  set_source_files_properties("${generated}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  pleinair_generates(${target} "${generated}")
endfunction()
