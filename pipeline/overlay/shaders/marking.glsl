// Purpose: the colours that are reserved for what is virtual (overlay::kReservedRgb).
// Inputs, outputs: none. Precision: mediump.
const vec3 kReserved = vec3(1.0, 0.16, 0.84);
const vec3 kCasing = vec3(0.10, 0.0, 0.09);
