#include "pipeline/scene/builtin/builtin_gear.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "pipeline/scene/builtin/solid_builder.h"

namespace pleinair::scene {
namespace {

using Side = SolidBuilder::Side;

constexpr int kDefaultHoles = 5;
constexpr std::size_t kHoleSegments = 36;
constexpr int kWebRows = 4;
constexpr std::size_t kMinCircleSegments = 72;
constexpr double kSmoothCosine = 0.9;  // edges of the outline that turn less are smoothed
const glm::dvec2 kAxis(0.0);

/// The gear's radii in metres, from the teeth inward.
struct GearPlan {
  double chamfer = 0.0;
  double rim = 0.0;       // inner edge of the face
  double webOuter = 0.0;  // outer edge of the recess' floor
  double webInner = 0.0;
  double hub = 0.0;
  double bore = 0.0;
  double holeCentre = 0.0;
  double hole = 0.0;
  int holes = 0;
  std::size_t segments = 0;  // of circles around the axis; a multiple of the number of holes
  bool hasRecess() const { return webOuter > webInner; }
};

double widestBore(const GearParameters& gear) {
  return 2.0 * (gearRadii(gear.form).rootMetres - 0.75 * gear.form.moduleMetres);
}

/// Half the angle of the web's sector around a hole. The whole sector is visible from the hole's
/// centre, past the hub, so that triangles can fan out from there.
double halfHoleSector(const GearPlan& plan, int holes) {
  const double pastHub = 0.9 * std::acos(std::min(1.0, plan.webInner / plan.holeCentre));
  return std::min(std::numbers::pi / holes, pastHub);
}

bool holesFit(const GearPlan& plan, int holes) {
  return plan.hasRecess() &&
         plan.holeCentre * std::sin(halfHoleSector(plan, holes)) > 1.5 * plan.hole;
}

GearPlan planOf(const GearParameters& gear) {
  const double m = gear.form.moduleMetres;
  const double pitchDiameter = m * gear.form.teeth;
  GearPlan plan;
  plan.bore = 0.5 * gear.boreDiameterMetres.value_or(0.18 * pitchDiameter);
  plan.chamfer = std::min({0.15 * m, 0.1 * gear.thicknessMetres, 0.25 * plan.bore});
  const double hubDiameter = gear.hubDiameterMetres.value_or(
      std::max(0.36 * pitchDiameter, 2.0 * plan.bore + 4.0 * plan.chamfer));
  plan.hub = 0.5 * hubDiameter;
  plan.rim = gearRadii(gear.form).rootMetres - 1.25 * m;
  // Draft angle, as on castings.
  const double draft = std::min(0.12 * gear.thicknessMetres, 0.4 * m);
  plan.webOuter = plan.rim - plan.chamfer - draft;
  plan.webInner = plan.hub + plan.chamfer + draft;
  if (plan.webOuter - plan.webInner < m) plan.webOuter = plan.webInner = 0.0;
  plan.holeCentre = 0.5 * (plan.webOuter + plan.webInner);
  plan.hole = 0.32 * (plan.webOuter - plan.webInner);
  plan.holes = gear.holes.value_or(holesFit(plan, kDefaultHoles) ? kDefaultHoles : 0);
  const auto unit = static_cast<std::size_t>(std::max(1, plan.holes));
  plan.segments = unit * ((kMinCircleSegments + unit - 1) / unit);
  return plan;
}

/// Heights of the rings of one side.
struct Heights {
  double face;
  double chamfer;
  double web;
  double holeChamfer;
};

Heights heightsOf(const GearParameters& gear, const GearPlan& plan, Side side) {
  const double top = gear.thicknessMetres;
  const double web = 0.3 * top;
  const double holeChamfer = 0.5 * plan.chamfer;
  if (side == Side::kUpper) {
    return {top, top - plan.chamfer, top - web, top - web - holeChamfer};
  }
  return {0.0, plan.chamfer, web, web + holeChamfer};
}

/// Outward normals of the outline's edges, and points moved inward by the chamfer.
class Outline {
 public:
  explicit Outline(GearProfile profile) : profile_(std::move(profile)) {
    const auto& points = profile_.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec2 along = points[(i + 1) % points.size()] - points[i];
      edgeNormals_.push_back(glm::normalize(glm::dvec2(along.y, -along.x)));
    }
  }

  const GearProfile& profile() const { return profile_; }

  Ring ring(double inset, double z) const {
    Ring ring;
    for (std::size_t i = 0; i < profile_.points.size(); ++i) {
      const glm::dvec2& a = edgeBefore(i);
      const glm::dvec2& b = edgeNormals_[i];
      const glm::dvec2 miter = (a + b) / (1.0 + glm::dot(a, b));
      ring.emplace_back(profile_.points[i] - inset * miter, z);
    }
    return ring;
  }

  /// Two normals per edge, tilted up by `lift` (0: upright wall, ±1: 45°).
  std::vector<glm::dvec3> normals(double lift) const {
    std::vector<glm::dvec3> normals;
    const std::size_t count = edgeNormals_.size();
    const auto lifted = [&](const glm::dvec2& own, const glm::dvec2& neighbour) {
      const bool isSmooth = glm::dot(own, neighbour) > kSmoothCosine;
      const glm::dvec2 flat = isSmooth ? glm::normalize(own + neighbour) : own;
      normals.push_back(glm::normalize(glm::dvec3(flat, lift)));
    };
    for (std::size_t i = 0; i < count; ++i) {
      lifted(edgeNormals_[i], edgeBefore(i));
      lifted(edgeNormals_[i], edgeNormals_[(i + 1) % count]);
    }
    return normals;
  }

 private:
  const glm::dvec2& edgeBefore(std::size_t i) const {
    return edgeNormals_[(i + edgeNormals_.size() - 1) % edgeNormals_.size()];
  }

  GearProfile profile_;
  std::vector<glm::dvec2> edgeNormals_;
};

/// Adds the end faces of the teeth. Returns the ring at their feet, which the rest of the face
/// joins.
Ring addTeeth(SolidBuilder& solid, Side side, const GearProfile& profile, const Ring& face) {
  Ring feet;
  for (std::size_t first = 0; first < face.size(); first += profile.pointsPerTooth) {
    const std::size_t last = first + profile.toothPoints - 1;
    for (std::size_t i = 0; 2 * i + 2 < profile.toothPoints; ++i) {
      solid.addFlat(side, std::array{face[first + i], face[first + i + 1], face[last - i - 1],
                                     face[last - i]});
    }
    feet.push_back(face[first]);
    for (std::size_t i = last; i < first + profile.pointsPerTooth; ++i) feet.push_back(face[i]);
  }
  return feet;
}

/// The recess' floor as a grid of rings from the hub outward. All its faces share these points.
std::vector<Ring> webRings(const GearPlan& plan, double z) {
  std::vector<Ring> rings;
  for (int i = 0; i <= kWebRows; ++i) {
    const double t = static_cast<double>(i) / kWebRows;
    // exact at both ends, where walls join
    const double radius = (1.0 - t) * plan.webInner + t * plan.webOuter;
    rings.push_back(circleRing(kAxis, radius, z, plan.segments));
  }
  return rings;
}

/// Fills the grid's columns [from, to).
void addWebColumns(SolidBuilder& solid, Side side, const std::vector<Ring>& web, std::size_t from,
                   std::size_t to) {
  const std::size_t segments = web[0].size();
  for (std::size_t column = from; column < to; ++column) {
    const std::size_t i = column % segments;
    const std::size_t j = (column + 1) % segments;
    for (std::size_t row = 1; row < web.size(); ++row) {
      solid.addFlat(side, std::array{web[row - 1][i], web[row][i], web[row][j], web[row - 1][j]});
    }
  }
}

/// The outline of the grid's columns [from, to).
Ring outlineOfColumns(const std::vector<Ring>& web, std::size_t from, std::size_t to) {
  const std::size_t segments = web[0].size();
  Ring outline;
  for (std::size_t i = from; i < to; ++i) outline.push_back(web.back()[i % segments]);
  for (std::size_t row = web.size(); row-- > 1;) outline.push_back(web[row][to % segments]);
  for (std::size_t i = to; i > from; --i) outline.push_back(web.front()[i % segments]);
  for (std::size_t row = 0; row + 1 < web.size(); ++row) {
    outline.push_back(web[row][from % segments]);
  }
  return outline;
}

/// Adds one hole's sector of the recess' floor, and the hole's chamfer.
void addHole(SolidBuilder& solid, Side side, const GearPlan& plan, const Heights& heights,
             int index) {
  const std::vector<Ring> web = webRings(plan, heights.web);
  const std::size_t columns = plan.segments / static_cast<std::size_t>(plan.holes);
  const std::size_t first = columns * static_cast<std::size_t>(index);
  const double columnRad = 2.0 * std::numbers::pi / static_cast<double>(plan.segments);
  std::size_t beside = 0;  // columns on either side of the hole that stay whole
  while (0.5 * static_cast<double>(columns - 2 * beside) * columnRad >
         halfHoleSector(plan, plan.holes) + 1e-9) {
    ++beside;
  }
  addWebColumns(solid, side, web, first, first + beside);
  addWebColumns(solid, side, web, first + columns - beside, first + columns);
  const Ring around = outlineOfColumns(web, first + beside, first + columns - beside);

  const double angle = 2.0 * std::numbers::pi * (index + 0.5) / plan.holes;
  const glm::dvec2 centre(plan.holeCentre * std::cos(angle), plan.holeCentre * std::sin(angle));
  const double wide = plan.hole + 0.5 * plan.chamfer;
  const Ring edge = circleRing(centre, wide, heights.web, kHoleSegments);
  const Ring wall = circleRing(centre, plan.hole, heights.holeChamfer, kHoleSegments);
  solid.addFlatBetween(side, around, edge, centre);
  solid.addTurnedBand(side, edge, wall, centre);
}

void addRecess(SolidBuilder& solid, Side side, const GearPlan& plan, const Heights& heights) {
  const auto circle = [&](double radius, double z) {
    return circleRing(kAxis, radius, z, plan.segments);
  };
  const auto band = [&](const Ring& from, const Ring& to) {
    solid.addTurnedBand(side, from, to, kAxis);
  };
  const Ring rimFoot = circle(plan.webOuter, heights.web);
  const Ring rimEdge = circle(plan.rim - plan.chamfer, heights.chamfer);
  band(circle(plan.rim, heights.face), rimEdge);
  band(rimEdge, rimFoot);
  const Ring hubFoot = circle(plan.webInner, heights.web);
  const Ring hubEdge = circle(plan.hub + plan.chamfer, heights.chamfer);
  if (plan.holes == 0) band(rimFoot, hubFoot);
  for (int i = 0; i < plan.holes; ++i) addHole(solid, side, plan, heights, i);
  band(hubFoot, hubEdge);
  band(hubEdge, circle(plan.hub, heights.face));
}

void addSide(SolidBuilder& solid, Side side, const GearPlan& plan, const Heights& heights,
             const Outline& outline) {
  const double lift = side == Side::kUpper ? 1.0 : -1.0;
  const Ring face = outline.ring(plan.chamfer, heights.face);
  solid.addBand(side, outline.ring(0.0, heights.chamfer), face, outline.normals(lift));
  const Ring feet = addTeeth(solid, side, outline.profile(), face);
  const Ring boreEdge = circleRing(kAxis, plan.bore + plan.chamfer, heights.face, plan.segments);
  if (plan.hasRecess()) {
    solid.addFlatBetween(side, feet, circleRing(kAxis, plan.rim, heights.face, plan.segments),
                         kAxis);
    addRecess(solid, side, plan, heights);
    solid.addFlatBetween(side, circleRing(kAxis, plan.hub, heights.face, plan.segments), boreEdge,
                         kAxis);
  } else {
    solid.addFlatBetween(side, feet, boreEdge, kAxis);
  }
  solid.addTurnedBand(side, boreEdge, circleRing(kAxis, plan.bore, heights.chamfer, plan.segments),
                      kAxis);
}

}  // namespace

std::optional<GearFault> faultOf(const GearParameters& gear) {
  assert(gear.form.teeth >= 6 && gear.form.moduleMetres > 0.0 && gear.thicknessMetres > 0.0);
  const GearPlan plan = planOf(gear);
  const double widest = widestBore(gear);
  if (2.0 * plan.bore > widest) {
    return GearFault{"bore_diameter_m",
                     fmt::format("found {:.6g}, too wide for the teeth", 2.0 * plan.bore),
                     fmt::format("at most {:.4g} here", widest)};
  }
  const double thinnestHub = 2.0 * plan.bore + 3.0 * plan.chamfer;
  if (gear.hubDiameterMetres && *gear.hubDiameterMetres < thinnestHub) {
    return GearFault{"hub_diameter_m",
                     fmt::format("found {:.6g}, too thin for the bore", *gear.hubDiameterMetres),
                     fmt::format("at least {:.4g} here", thinnestHub)};
  }
  if (plan.holes != 0 && !holesFit(plan, plan.holes)) {
    int max = 12;
    while (max > 0 && !holesFit(plan, max)) --max;
    return GearFault{"holes", fmt::format("found {}, which do not fit into the web", plan.holes),
                     max == 0 ? "0 here" : fmt::format("0, or at most {} here", max)};
  }
  return std::nullopt;
}

Mesh gearMesh(const GearParameters& gear) {
  assert(!faultOf(gear));
  const GearPlan plan = planOf(gear);
  const Outline outline(gearProfile(gear.form));
  SolidBuilder solid;
  const Heights upper = heightsOf(gear, plan, Side::kUpper);
  const Heights lower = heightsOf(gear, plan, Side::kLower);
  addSide(solid, Side::kUpper, plan, upper, outline);
  addSide(solid, Side::kLower, plan, lower, outline);
  // upright walls: teeth, bore, holes
  solid.addBand(Side::kUpper, outline.ring(0.0, lower.chamfer), outline.ring(0.0, upper.chamfer),
                outline.normals(0.0));
  solid.addTurnedBand(Side::kUpper, circleRing(kAxis, plan.bore, upper.chamfer, plan.segments),
                      circleRing(kAxis, plan.bore, lower.chamfer, plan.segments), kAxis);
  for (int i = 0; i < plan.holes; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / plan.holes;
    const glm::dvec2 centre(plan.holeCentre * std::cos(angle), plan.holeCentre * std::sin(angle));
    solid.addTurnedBand(Side::kUpper,
                        circleRing(centre, plan.hole, upper.holeChamfer, kHoleSegments),
                        circleRing(centre, plan.hole, lower.holeChamfer, kHoleSegments), centre);
  }
  return solid.take();
}

}  // namespace pleinair::scene
