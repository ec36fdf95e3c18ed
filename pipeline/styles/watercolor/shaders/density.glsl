// Purpose: paint as optical density, in which the pigments of layers add up (Beer-Lambert: pigments
//          absorb and do not scatter, which is the Kubelka-Munk model of transparent paint over
//          white).
// Inputs, outputs: sRGB-coded colours; densities in [0, 8] in base 2; both packed for 8-bit
//          textures as square roots, because thin layers matter most.
// Precision: highp.
vec3 densityOf(vec3 colour) { return -log2(max(colour, vec3(0.004))); }
vec3 colourOf(vec3 density) { return exp2(-density); }
vec3 packDensity(vec3 density) { return sqrt(clamp(density * 0.125, 0.0, 1.0)); }
vec3 unpackDensity(vec3 packed_) { return 8.0 * packed_ * packed_; }
