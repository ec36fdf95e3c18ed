// Purpose: ArFrame::ids (scene/ar_frame.h): an object in the upper bits, 0 for the camera's picture,
//          and a number of its own, a triangle's or a part's, in the lower ones.
const uint kNumberBits = 22u;

uint idOf(uint object, uint number) { return object << kNumberBits | number; }
uint objectOf(uint id) { return id >> kNumberBits; }
uint numberOf(uint id) { return id & ((1u << kNumberBits) - 1u); }
