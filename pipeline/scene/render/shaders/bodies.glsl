// Purpose: bodies that move as one in front of the camera, and projection of their points.
// Inputs:  focal, centre: of the pinhole in px. Bodies (scene::SurfacePass writes them) come in
//          uniform blocks, which are read once for all invocations, or, where each invocation has
//          another one, in a storage buffer.
// Outputs: position of a point of a body, in metres and in px, and its predicted error.
// Precision: highp; metres, camera frame, px.
#include "pipeline/scene/render/shaders/lens.glsl"

struct Body {
  vec4 current[3];   // rows: camera from body in this frame
  vec4 previous[3];  // in the previous frame
  vec4 turnsAbout;  // origin of the pose errors; w: 1 if known in both frames
  vec4 errorTurns[6];  // square root of the poses' covariance, column by column: rad
  vec4 errorShifts[6];  // metres
  vec4 extent;  // half the size of a plane
  // of a model: first triangle, first vertex in this frame and in the previous one; whether it is
  // drawn in this frame
  uvec4 places;
  vec4 padding[11];     // to a block's alignment
};

uniform vec2 focal;
uniform vec2 centre;

vec3 transformed(vec4 rows[3], vec3 p) {
  vec4 q = vec4(p, 1.0);
  return vec3(dot(rows[0], q), dot(rows[1], q), dot(rows[2], q));
}

// Precondition: z > 0.
vec2 projected(vec3 p) {
  vec3 bent = throughLens(p);
  return focal * bent.xy / bent.z + centre;
}

// Predicted error of a real body's point: one standard deviation over both axes, in px. Ignores the
// lens, which bends too little to matter here.
float predictedError(Body body, vec3 p) {
  vec3 arm = p - body.turnsAbout.xyz;
  float variance = 0.0;
  for (int i = 0; i < 6; ++i) {
    vec3 d = cross(body.errorTurns[i].xyz, arm) + body.errorShifts[i].xyz;
    vec2 px = focal * (d.xy - p.xy / p.z * d.z) / p.z;
    variance += dot(px, px);
  }
  return sqrt(variance);
}
