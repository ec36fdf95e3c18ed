# Shaders are files beside the code that runs them. They are embedded at build under their path
# from the top of the tree ("pipeline/gpu/shaders/fullscreen.vert"), and a directory given at run
# time overrides them (gpu::ShaderLibrary).

# pleinair_embed_shaders(TARGET LISTER file ...): embeds the files, named relative to the current
# source directory, into TARGET, which gains `std::span<const EmbeddedShader> gpu::LISTER()`.
function(pleinair_embed_shaders target lister)
  set(generated "${CMAKE_CURRENT_BINARY_DIR}/${target}_shaders.cpp")
  set(inputs)
  foreach(shader IN LISTS ARGN)
    list(APPEND inputs "${CMAKE_CURRENT_SOURCE_DIR}/${shader}")
  endforeach()
  list(JOIN inputs "|" joined)
  add_custom_command(
    OUTPUT "${generated}"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${generated}" "-DROOT=${CMAKE_SOURCE_DIR}"
            "-DLISTER=${lister}" "-DINPUTS=${joined}" -P "${CMAKE_SOURCE_DIR}/cmake/EmbedShaders.cmake"
    DEPENDS ${inputs} "${CMAKE_SOURCE_DIR}/cmake/EmbedShaders.cmake"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}")
endfunction()
