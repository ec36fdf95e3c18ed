#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "hal/cameras/synthetic/render/exposure.h"
#include "hal/cameras/synthetic/render/projection.h"
#include "hal/cameras/synthetic/render/scan_line.h"
#include "hal/cameras/synthetic/world/world.h"

namespace pleinair::hal::synthetic {

/// Renders the workbench row by row. Keeps its memory from frame to frame. One thread per renderer;
/// any number of renderers may share a world.
class Renderer {
 public:
  explicit Renderer(std::shared_ptr<const World> world) : world_(std::move(world)) {}

  /// Begins an image. Keeps a reference to `exposure` until the next call.
  void begin(const Exposure& exposure);

  /// Renders the next row, from row 0 on: three sRGB-coded levels per pixel, in sixty-fourths.
  std::span<const std::int16_t> nextRow();

 private:
  /// A facet that may be visible, and the rows that it may reach.
  struct Candidate {
    std::uint32_t facet = 0;
    Body body = kRoom;
    int firstRow = 0, endRow = 0;
  };
  /// The camera's view of the bodies at one time.
  struct Moment {
    PinholeIntrinsics intrinsics;
    BodyPoses bodies;
    std::array<glm::dmat4, kBodies> cameraFromBody{};  ///< of the bodies in the scene
  };
  Moment momentAt(double y) const;
  void addStanding(const Solid& solid, const Moment& moment);
  void addRolling(const Solid& solid, std::span<const Moment> moments);
  void addCandidate(std::uint32_t facet, Body body, float top, float bottom);
  bool isWithin(const ProjectedFacet& facet, float margin) const;
  ProjectedFacet& slotFor(std::size_t index);
  void projectActive();
  void shade();
  void shadeMixed(int x);
  void sampleOrDark(std::uint16_t index, int x, int count, std::int16_t* levels) const;

  std::shared_ptr<const World> world_;
  const Exposure* exposure_ = nullptr;
  int row_ = 0;
  std::vector<Moment> moments_;  ///< of some rows, from the first to the last
  std::vector<Candidate> candidates_;
  std::vector<ProjectedFacet> projected_;  ///< each candidate at the current row's time
  std::vector<std::uint16_t> order_;       ///< indices of candidates, by first row
  std::size_t next_ = 0;                   ///< in order_, the first one not yet reached
  std::vector<std::uint16_t> active_;      ///< candidates that may reach the row
  ProjectedFacet scratch_;
  ScanLine line_;
  std::vector<std::int16_t> levels_;
};

}  // namespace pleinair::hal::synthetic
