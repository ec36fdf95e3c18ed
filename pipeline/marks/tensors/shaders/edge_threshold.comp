// Purpose: the threshold of a strong edge of the background in this frame, by which those of movers
//          and models are judged, too: a third of the 99.5th percentile of P, smoothed in time (the
//          thesis takes a third of the maximum, which one bright object or hot pixel changes). It
//          has an upper limit, and that of edges that lead strokes a lower one: weaker edges are
//          seen, however strong others are.
//          A frame without any counted pixel leaves it as it is.
// Inputs:  bins (edge_histogram.comp; cleared here); share: of the way to this frame's value, in
//          [0, 1]; least: everything below is noise; most: the limits of `threshold` and of
//          `leadingThreshold`.
// Outputs: threshold, leadingThreshold. One invocation.
// Precision: highp.
#include "pipeline/marks/tensors/shaders/edge_bins.glsl"
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Edges { EdgeStrengths frameEdges; };
uniform float share;
uniform float least;
uniform vec2 most;

void main() {
  uint all = 0u;
  for (int i = 0; i < kBins; ++i) all += frameEdges.bins[i];
  uint above = 0u;
  float percentile = 0.0;
  for (int i = kBins - 1; i >= 0; --i) {
    uint here = frameEdges.bins[i];
    frameEdges.bins[i] = 0u;
    if (percentile == 0.0 && here > 0u && (above + here) * 200u >= all) {
      float part = clamp((float(all) / 200.0 - float(above)) / float(here), 0.0, 1.0);
      percentile = strengthOf(float(i) + 1.0 - part);
    }
    above += here;
  }
  float goal = all > 0u ? min(percentile / 3.0, most.x) : frameEdges.threshold;
  frameEdges.threshold = max(mix(frameEdges.threshold, goal, share), least);
  frameEdges.leadingThreshold = min(frameEdges.threshold, most.y);
}
