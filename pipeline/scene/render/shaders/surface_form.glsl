// Purpose: packs and unpacks the form of surfaces: of triangles (scene::DrawnForm), and of pixels
//          (ArFrame::forms): from the lowest bit, 12 bits of a label, which differs where a painter
//          sees a border (objects, parts, materials, creases, limbs); 12 bits of the angle of a
//          line in the image, k · π / 4096; 5 bits of how clear that direction is; a bit on limbs; a
//          bit where trunk and limb meet on a smooth surface; a bit where the model's author
//          declares the direction.
// Inputs, outputs: packed, or in parts.
// Precision: integers; highp.
const uint kLabels = 4096u;
const uint kMostMoverLabels = 3u;
const uint kMoverLabel = kLabels - 1u;  // of what moves by itself before the camera: the first mover
const uint kAnyPatch = kLabels - 1u - kMostMoverLabels;  // of a model's surface whose patch is not known
const float kLineStep = 3.14159265 / 4096.0;
const uint kOnLimb = 1u << 29u;
const uint kAtJoint = 1u << 30u;
const uint kDeclared = 1u << 31u;
const uint kMarks = kOnLimb | kAtJoint | kDeclared;

uint patchOf(uint drawn) { return drawn & 4095u; }
// Along the direction: the shares of the first two corners, from the last one.
vec2 cornersAlong(uint drawn) {
  float angle = float(drawn >> 12u & 4095u) * kLineStep;
  return vec2(cos(angle), sin(angle));
}
float clarityOf(uint form) { return float(form >> 24u & 31u) / 31.0; }
bool isDeclared(uint form) { return (form & kDeclared) != 0u; }

// Up to 4,092 patches of one object have different labels; the ranges of objects whose numbers
// differ by less than 12 begin 212 apart at least. 0 is the camera image's, also where an occluder
// is.
uint labelOfPatch(uint object, uint number) {
  return 1u + (object * 2531u + number) % kAnyPatch;
}
// Of a mover, from 1 on.
uint labelOfMover(int number) { return kMoverLabel + 1u - uint(number); }
bool isMoverLabel(uint label) { return label < kLabels && label >= kLabels - kMostMoverLabels; }
int moverOfLabel(uint label) { return int(kLabels - label); }
uint labelOf(uint form) { return form & 4095u; }

// Whether one of two pixels is on the limb's side of a joint and the other on the trunk's: unless a
// step of depth lies between them, their labels tell no border that a painter sees.
bool isOneJoint(uint a, uint b) {
  return (a & b & kAtJoint) != 0u && ((a ^ b) & kOnLimb) != 0u;
}

const float kOverJoint = 16.0;  // px of the full image, so far do strokes go on beyond a joint

// `marks`: any of kMarks.
uint formOf(uint label, vec2 along, float clarity, uint marks) {
  float angle = atan(along.y, along.x);
  uint line = uint(int(round(angle / kLineStep)) + 8192) & 4095u;
  return label | line << 12u | uint(clarity * 31.0 + 0.5) << 24u | marks;
}
// The tensor of a gradient across the line, as strokes run across gradients; its length is the
// clarity.
vec2 tensorOf(uint form) {
  float doubled = 2.0 * float(form >> 12u & 4095u) * kLineStep;
  return -clarityOf(form) * vec2(cos(doubled), sin(doubled));
}
