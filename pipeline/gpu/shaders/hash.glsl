// Purpose: repeatable randomness from integers, the same on every GPU (PCG, Jarzynski and Olano,
//          "Hash functions for GPU rendering", 2020).
// Inputs, outputs: 32-bit integers.
// Precision: highp; integers are exact.
uint hashOf(uint value) {
  uint state = value * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}
uint hashOf(ivec2 at, uint salt) { return hashOf(uint(at.x) + hashOf(uint(at.y) + hashOf(salt))); }
// In [0, 1): 24 bits, exact in a float.
float unitOf(uint hash) { return float(hash >> 8u) * (1.0 / 16777216.0); }
