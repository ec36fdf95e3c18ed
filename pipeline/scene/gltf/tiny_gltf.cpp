// Compiles tinygltf with the options of gltf_structure.h. (Debian's shared library includes stb's
// image decoders and file access.)
#include <fstream>  // needed even without files

#define TINYGLTF_IMPLEMENTATION
#include "pipeline/scene/gltf/gltf_structure.h"
