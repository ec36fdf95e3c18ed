#pragma once

// OpenGL ES 3.1 and the extensions we know by name.
#include <GLES3/gl31.h>
// after the core header, whose types it uses
#include <GLES2/gl2ext.h>
