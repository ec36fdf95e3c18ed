// tinygltf's own code, compiled with the choices of gltf_structure.h. (Debian's shared library has
// stb's picture decoders and file access in it.)
#include <fstream>  // which it needs even without files

#define TINYGLTF_IMPLEMENTATION
#include "pipeline/scene/gltf/gltf_structure.h"
