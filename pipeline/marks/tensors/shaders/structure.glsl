// Purpose: whether two pictures of a place have the same structure: then only its light differs.
// Inputs:  pairs of lumas.
// Outputs: variances and correlation.
// Precision: highp.
struct Structure {
  vec2 sum;
  vec3 products;  // sums of xx, yy, xy
  float count;
};

const float kLeastContrast = 0.02;  // of luma
const float kSameStructure = 0.9;  // correlation

Structure noStructure() { return Structure(vec2(0.0), vec3(0.0), 0.0); }

void add(inout Structure s, vec2 lumas) {
  s.sum += lumas;
  s.products += vec3(lumas * lumas, lumas.x * lumas.y);
  s.count += 1.0;
}

vec2 variancesOf(Structure s) {
  vec2 mean = s.sum / s.count;
  return max(s.products.xy / s.count - mean * mean, 0.0);
}

// Whether at least one of the pictures has edges.
bool hasEdges(Structure s) {
  vec2 variances = variancesOf(s);
  return max(variances.x, variances.y) > kLeastContrast * kLeastContrast;
}

// Whether both have edges of this contrast, and these correlate by more than that.
bool correlates(Structure s, float contrast, float correlation) {
  vec2 variances = variancesOf(s);
  float covariance = (s.products.z - s.sum.x * s.sum.y / s.count) / s.count;
  return min(variances.x, variances.y) > contrast * contrast &&
         covariance > correlation * sqrt(variances.x * variances.y);
}

// Whether both have the same ones.
bool isSame(Structure s) { return correlates(s, kLeastContrast, kSameStructure); }
