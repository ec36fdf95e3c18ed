// Purpose: a feature of the camera image and its motion (marks/motion_field.cpp, GpuFeature).
// Inputs, outputs: px of the full image.
// Precision: highp.
struct Feature {
  vec4 places;  // previous, current
  vec4 about;  // predicted error; the real object that it lies on, 0: none, below 0: on a border
};
