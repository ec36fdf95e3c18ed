// Purpose: what strokes may lie on, by 13 bits of a label: of a pixel, and of a stroke's birth or
//          anchor. 0: the camera image; up to 4,092: a patch of a model (surface_form.glsl); up to
//          4,095: a mover; from kSegmentLabel on: a segment of the camera image.
// Inputs, outputs: labels.
// Precision: integers.
const uint kLabelMask = 8191u;
const uint kSegmentLabel = 4096u;

// Whether a label is the camera image's, but for movers.
bool isGround(uint label) { return label == 0u || label >= kSegmentLabel; }

// Whether a label is a model's.
bool isPatch(uint label) { return label != 0u && label < kSegmentLabel - 3u; }

// Whether a label is a mover's.
bool isMover(uint label) { return label < kSegmentLabel && label >= kSegmentLabel - 3u; }

// Whether a label is a model's or a mover's: what does not go with the camera image.
bool goesByItself(uint label) { return label != 0u && label < kSegmentLabel; }

// Whether a stroke may cover a place. Where the image has no segment, none ends a stroke, nor does
// any end a stroke without one.
bool mayCover(uint label, uint there) {
  return label == there || (isGround(label) && isGround(there) && (label == 0u || there == 0u));
}
