# Shaders are files beside the code that runs them. The build embeds each under its path from the top
# of the tree ("pipeline/gpu/shaders/fullscreen.vert"); files in a directory given at run time replace
# them (gpu::ShaderLibrary).

# pleinair_embed_shaders(TARGET LISTER file ...): embeds the files, named relative to the current
# source directory, into TARGET, which gains `std::span<const EmbeddedShader> gpu::LISTER()`. For a
# target pleinair_NAME, the header NAME_shaders.h in the source directory's namespace declares it.
function(pleinair_embed_shaders target lister)
  string(REPLACE "pleinair_" "" name "${target}")
  file(RELATIVE_PATH module "${CMAKE_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  set(generated "${CMAKE_BINARY_DIR}/generated/${module}/${name}_shaders")
  set(inputs)
  foreach(shader IN LISTS ARGN)
    list(APPEND inputs "${CMAKE_CURRENT_SOURCE_DIR}/${shader}")
  endforeach()
  list(JOIN inputs "|" joined)
  add_custom_command(
    OUTPUT "${generated}.cpp" "${generated}.h"
    COMMAND "${CMAKE_COMMAND}" "-DOUTPUT=${generated}" "-DROOT=${CMAKE_SOURCE_DIR}"
            "-DLISTER=${lister}" "-DHEADER=${module}/${name}_shaders.h"
            "-DINPUTS=${joined}" -P "${CMAKE_SOURCE_DIR}/cmake/EmbedShaders.cmake"
    DEPENDS ${inputs} "${CMAKE_SOURCE_DIR}/cmake/EmbedShaders.cmake"
    VERBATIM)
  target_sources(${target} PRIVATE "${generated}.cpp" "${generated}.h")
  pleinair_generates(${target} "${generated}.cpp" "${generated}.h")
  target_include_directories(${target} PUBLIC "${CMAKE_BINARY_DIR}/generated")
endfunction()
