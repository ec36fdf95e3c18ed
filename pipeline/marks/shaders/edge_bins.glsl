// Purpose: the histogram bins of edge strengths.
// Inputs, outputs: P in [0, 4√2]; bins are uniform in its square root, because weak edges are many.
// Precision: highp.
const int kBins = 128;
const float kMostEdge = 5.7;

int binOf(float p) { return min(int(sqrt(p / kMostEdge) * float(kBins)), kBins - 1); }
float strengthOf(float bin) {
  float root = bin / float(kBins);
  return root * root * kMostEdge;
}
