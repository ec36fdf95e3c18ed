// Purpose: tensors of regions (thesis §4.2, step 1): the sums over a region's pixels of one kind,
//          and their blend with the past.
// Inputs:  threshold, leadingThreshold (edge_threshold.comp); tensors of pixels (gradient.frag).
// Outputs: a region: tensor (its length is the agreement of its pixels, in [0, 1]), its confidence
//          in [0, 1]; detail: the mean P in units of `threshold`.
// Precision: highp.

// So many px of an edge that leads strokes give full confidence.
const float kSurePixels = 4.0;

// Rotates a tensor by an angle.
vec2 turned(vec2 tensor, float angle) {
  float c = cos(2.0 * angle);
  float s = sin(2.0 * angle);
  return vec2(c * tensor.x - s * tensor.y, s * tensor.x + c * tensor.y);
}

// A tensor whose strokes lie on a surface, after the surface's motion; `jacobian`: of its places in
// the image. Strokes run across the gradient.
vec2 carriedBy(vec2 tensor, mat2 jacobian) {
  float size = length(tensor);
  // Exact at rest: what is held must not drift by rounding.
  if (size < 1e-6 || jacobian == mat2(1.0)) return tensor;
  vec2 cosines = tensor / size;
  vec2 gradient = sqrt(max(vec2(0.5 + 0.5 * cosines.x, 0.5 - 0.5 * cosines.x), 0.0));
  if (tensor.y < 0.0) gradient.y = -gradient.y;
  vec2 stroke = jacobian * vec2(-gradient.y, gradient.x);
  return size * vec2(stroke.y * stroke.y - stroke.x * stroke.x, -2.0 * stroke.x * stroke.y) /
         max(dot(stroke, stroke), 1e-12);
}

// Sums over the pixels of one kind.
struct Edge {
  vec2 sum;
  float strengths;
  float sure;
  float edges;
  float pixels;
};

const Edge kNoEdge = Edge(vec2(0.0), 0.0, 0.0, 0.0, 0.0);

void add(inout Edge edge, vec2 tensor, float part, float leadingThreshold) {
  float p = length(tensor);
  // A soft threshold, so that noise does not switch it.
  float weight = part * smoothstep(0.6, 1.4, p / leadingThreshold);
  edge.sum += weight * tensor;
  edge.strengths += weight * p;
  edge.sure += weight;
  edge.edges += part * p;
  edge.pixels += part;
}

vec4 regionOf(Edge edge, float threshold, float pixelsOfFull) {
  return vec4(edge.strengths > 0.0 ? edge.sum / edge.strengths : vec2(0.0),
              min(edge.sure / (kSurePixels * pixelsOfFull), 1.0),
              edge.edges / (max(edge.pixels, 1.0) * threshold));
}

// The mean of now and the past, which counts by its confidence; a direction that has vanished
// fades. Detail is held until it differs by more than its slack, so that noise moves no region to
// another layer.
vec4 held(vec4 now, vec4 old, float stays, float slack) {
  float oldWeight = stays * old.z;
  float newWeight = (1.0 - stays) * now.z;
  vec2 tensor = oldWeight + newWeight > 0.0
                    ? (oldWeight * old.xy + newWeight * now.xy) / (oldWeight + newWeight)
                    : vec2(0.0);
  float detail = clamp(old.w, now.w * (1.0 - slack), now.w / (1.0 - slack));
  return vec4(tensor, oldWeight + newWeight, mix(detail, old.w, stays));
}
