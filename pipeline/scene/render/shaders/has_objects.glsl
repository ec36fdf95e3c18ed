// Purpose: whether the frame has objects (ArFrame::hasObjects).
// Defines: NO_OBJECTS: no frame of the scene has any (scene/render/object_programs.h).
// Inputs:  hasObjects.
// Outputs: the same.
// Precision: none is needed.
#ifdef NO_OBJECTS
const bool hasObjects = false;
#else
uniform bool hasObjects;
#endif
