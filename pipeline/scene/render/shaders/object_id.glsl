// Purpose: packs and unpacks ArFrame::ids (scene/render/ar_frame.h).
// Inputs:  an object, 0 for the camera image, and the number of its triangle or part; or an id.
// Outputs: the id, or its contents: the object in the upper 10 bits.
// Precision: integers.
const uint kNumberBits = 22u;

uint idOf(uint object, uint number) { return object << kNumberBits | number; }
uint objectOf(uint id) { return id >> kNumberBits; }
uint numberOf(uint id) { return id & ((1u << kNumberBits) - 1u); }

// Flag of occluders, where the camera image is visible (scene::kRealObject).
const uint kRealObject = 512u;
bool isVirtual(uint object) { return object != 0u && object < kRealObject; }
