// Purpose: the histogram of edge strengths, and the thresholds that come from it.
// Inputs, outputs: P in [0, 4√2]; bins are uniform in its square root, because weak edges are many.
// Precision: highp.
const int kBins = 128;
const float kMaxEdge = 5.7;

struct EdgeStrengths {
  float threshold;         // of a strong edge: the unit of detail
  float leadingThreshold;  // of one that leads strokes
  uint bins[kBins];
};

int binOf(float p) { return min(int(sqrt(p / kMaxEdge) * float(kBins)), kBins - 1); }
float strengthOf(float bin) {
  float root = bin / float(kBins);
  return root * root * kMaxEdge;
}
