// Purpose: parts of a machine as a mask with shading.
// Inputs:  normal in the camera's frame, of any length.
// Outputs: RGBA8, of which the caller masks channels: R 1 where there is a part; G: its shading, 0.2 … 1.
// Precision: mediump.
in vec3 cameraNormal;

layout(location = 0) out vec4 figure;

void main() {
  float facing = abs(normalize(cameraNormal + vec3(0.0, 0.0, 1e-9)).z);
  figure = vec4(1.0, 0.35 + 0.65 * facing, 0.0, 1.0);
}
