// Purpose: what ArFrame::ids pack (scene/ar_frame.h).
// Inputs:  an object, 0 for the camera's picture, and a number of its own, a triangle's or a part's;
//          or an id.
// Outputs: the id, or what is in it: the object in the upper 10 bits.
// Precision: integers.
const uint kNumberBits = 22u;

uint idOf(uint object, uint number) { return object << kNumberBits | number; }
uint objectOf(uint id) { return id >> kNumberBits; }
uint numberOf(uint id) { return id & ((1u << kNumberBits) - 1u); }

// Occluders: what is seen there is the camera's picture (scene::kRealObject).
const uint kRealObject = 512u;
bool isVirtual(uint object) { return object != 0u && object < kRealObject; }
