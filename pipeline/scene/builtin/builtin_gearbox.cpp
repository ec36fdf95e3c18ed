#include "pipeline/scene/builtin/builtin_gearbox.h"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include "pipeline/scene/builtin/gearbox_parts.h"
#include "pipeline/scene/builtin/gearbox_plan.h"
#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

enum class Finish { kCastIron, kSteel, kPinion, kWheel, kBrass, kDarkSteel, kRed, kGlass };

struct FinishColour {
  const char* name;
  glm::vec3 linearRgb;
};

FinishColour colourOf(Finish finish) {
  switch (finish) {
    case Finish::kCastIron:
      return {"cast iron", {0.100F, 0.215F, 0.230F}};
    case Finish::kSteel:
      return {"steel", {0.560F, 0.590F, 0.620F}};
    case Finish::kPinion:
      return {"hardened steel", {0.240F, 0.300F, 0.400F}};
    case Finish::kWheel:
      return {"bronze", {0.620F, 0.390F, 0.150F}};
    case Finish::kBrass:
      return {"brass", {0.640F, 0.420F, 0.080F}};
    case Finish::kDarkSteel:
      return {"blackened steel", {0.060F, 0.062F, 0.070F}};
    case Finish::kRed:
      return {"red paint", {0.440F, 0.035F, 0.022F}};
    case Finish::kGlass:
      return {"glass", {0.560F, 0.330F, 0.030F}};
  }
  return {"", {}};
}

/// Assembles the parts. Equal bearings and bolts share their surfaces.
class Assembly {
 public:
  explicit Assembly(const glm::dmat4& modelFromPlan) : modelFromPlan_(modelFromPlan) {}

  std::size_t addSurface(Mesh mesh, Finish finish) {
    const auto known = materials_.find(finish);
    const std::size_t material = known != materials_.end() ? known->second : addMaterial(finish);
    model_.surfaces.push_back({.mesh = std::move(mesh), .material = material});
    return model_.surfaces.size() - 1;
  }

  void addPart(std::string name, std::size_t surface, const glm::dmat4& place,
               double radiansPerSecond = 0.0, std::size_t surfaceCount = 1) {
    model_.parts.push_back({.name = std::move(name),
                            .firstSurface = surface,
                            .surfaceCount = surfaceCount,
                            .modelFromPart = modelFromPlan_ * place,
                            .radiansPerSecond = radiansPerSecond});
  }
  void addPart(std::string name, Mesh mesh, Finish finish, const glm::dmat4& place,
               double radiansPerSecond = 0.0) {
    addPart(std::move(name), addSurface(std::move(mesh), finish), place, radiansPerSecond);
  }

  Model take() {
    numberParts(model_);
    return std::move(model_);
  }

 private:
  std::size_t addMaterial(Finish finish) {
    const FinishColour colour = colourOf(finish);
    model_.materials.push_back(
        {.name = colour.name, .baseColour = glm::vec4(colour.linearRgb, 1.0F)});
    materials_[finish] = model_.materials.size() - 1;
    return materials_[finish];
  }

  glm::dmat4 modelFromPlan_;
  Model model_;
  std::map<Finish, std::size_t> materials_;
};

const glm::dmat4 kAsIs(1.0);

/// The frame of a part on a shaft's axis, `y` from the housing's centre: z towards the reader, x
/// along the gearbox, y up.
glm::dmat4 onAxis(const GearboxPlan& plan, double x, double y) {
  return {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -1.0, 0.0, 0.0, x, y, plan.axisHeight, 1.0};
}

/// The frame of a part on the same axis that faces away from the reader.
glm::dmat4 onAxisBack(const GearboxPlan& plan, double x, double y) {
  return glm::rotate(onAxis(plan, x, y), 0.5 * kTurn, {0.0, 1.0, 0.0});
}

void addGears(Assembly& assembly, const GearboxPlan& plan) {
  for (std::size_t i = 0; i < plan.gears.size(); ++i) {
    const GearboxGear& gear = plan.gears[i];
    const bool isWheel = i % 2 == 1;
    GearParameters made{.form = gear.form, .thicknessMetres = plan.faceWidths[i]};
    made.boreDiameterMetres = 2.0 * plan.seats[i];
    if (!isWheel) made.holes = 0;
    // the part turns about z; the teeth's phase at rest is part of its place
    const double low = plan.faceMiddles[i] + 0.5 * plan.faceWidths[i];
    const glm::dmat4 place =
        glm::rotate(onAxis(plan, gear.centre.x, low), gear.phaseRad, {0.0, 0.0, 1.0});
    assembly.addPart(fmt::format("gear_{}", i + 1), gearMesh(made),
                     isWheel ? Finish::kWheel : Finish::kPinion, place, gear.radiansPerSecond);
  }
}

void addShafts(Assembly& assembly, const GearboxPlan& plan) {
  const auto& [input, intermediate, output] = plan.shafts;
  assembly.addPart("input_shaft", inputShaftMesh(plan), Finish::kSteel, onAxis(plan, input.x, 0.0),
                   input.radiansPerSecond);
  assembly.addPart("intermediate_shaft", intermediateShaftMesh(plan), Finish::kSteel,
                   onAxis(plan, intermediate.x, 0.0), intermediate.radiansPerSecond);
  assembly.addPart("output_shaft", outputShaftMesh(plan), Finish::kSteel,
                   onAxis(plan, output.x, 0.0), output.radiansPerSecond);
  assembly.addPart("output_key", outputKeyMesh(), Finish::kBrass, onAxis(plan, output.x, 0.0),
                   output.radiansPerSecond);
  assembly.addPart("input_coupling", couplingMesh(), Finish::kRed, onAxis(plan, input.x, 0.0),
                   input.radiansPerSecond);
}

void addBearings(Assembly& assembly, const GearboxPlan& plan) {
  const double middle = 0.5 * (kBearingNear + kBearingFar);
  int number = 1;
  for (const GearboxPlan::Shaft& shaft : plan.shafts) {
    const std::size_t outer = assembly.addSurface(outerRaceMesh(shaft), Finish::kSteel);
    const std::size_t inner = assembly.addSurface(innerRaceMesh(shaft), Finish::kPinion);
    const std::size_t balls = assembly.addSurface(ballsMesh(shaft), Finish::kSteel);
    assembly.addSurface(cageMesh(shaft), Finish::kBrass);  // part of the visible balls
    for (const double y : {-middle, middle}) {
      const std::string name = fmt::format("bearing_{}", number++);
      const glm::dmat4 place = onAxis(plan, shaft.x, y);
      assembly.addPart(name + "_outer_race", outer, place);
      assembly.addPart(name + "_inner_race", inner, place, shaft.radiansPerSecond);
      assembly.addPart(name + "_balls", balls, place, cageRatio(shaft) * shaft.radiansPerSecond, 2);
    }
  }
}

/// Adds covers over the ends of shafts that do not leave the housing: at the back, and at the front
/// of the output shaft.
void addEndCovers(Assembly& assembly, const GearboxPlan& plan, std::vector<glm::dmat4>& bolts) {
  constexpr int kBolts = 4;
  const std::array<std::pair<std::size_t, bool>, 3> ends{{{0, false}, {1, false}, {2, true}}};
  int number = 1;
  for (const auto& [index, isFront] : ends) {
    const GearboxPlan::Shaft& shaft = plan.shafts[index];
    const double y = kHalfBoss + 0.0009;
    const glm::dmat4 place = isFront ? onAxis(plan, shaft.x, -y) : onAxisBack(plan, shaft.x, y);
    assembly.addPart(fmt::format("end_cover_{}", number++), endCoverMesh(shaft), Finish::kCastIron,
                     place);
    const double circle = 0.5 * (shaft.bossRadius() + 0.6 * shaft.bearingOuter + 0.001);
    for (int i = 0; i < kBolts; ++i) {
      const double angle = kTurn * (i + 0.5) / kBolts;
      bolts.push_back(
          glm::translate(place, {circle * std::cos(angle), circle * std::sin(angle), 0.0038}));
    }
  }
}

void addBolts(Assembly& assembly, const GearboxPlan& plan, const std::vector<glm::dmat4>& small) {
  const std::size_t head = assembly.addSurface(hexHead(0.010, 0.0062), Finish::kDarkSteel);
  const std::size_t smallHead = assembly.addSurface(hexHead(0.0052, 0.0032), Finish::kDarkSteel);
  int number = 1;
  const auto add = [&](std::size_t surface, const glm::dmat4& place, double rate = 0.0) {
    assembly.addPart(fmt::format("bolt_{}", number++), surface, place, rate);
  };
  for (const glm::dmat4& place : footBolts(plan)) add(head, place);
  for (const glm::dmat4& place : small) add(smallHead, place);
}

/// Adds all bolts of a coupling as one part, since they turn with it.
void addCouplingBolts(Assembly& assembly, const GearboxPlan& plan) {
  constexpr int kBolts = 6;
  const Mesh head = hexHead(0.0052, 0.0032);
  Mesh bolts;
  for (int i = 0; i < kBolts; ++i) {
    const double angle = kTurn * i / kBolts;
    append(bolts, head,
           glm::translate(glm::dmat4(1.0), {kCouplingBoltCircle * std::cos(angle),
                                            kCouplingBoltCircle * std::sin(angle), kCouplingFace}));
  }
  assembly.addPart("coupling_bolts", std::move(bolts), Finish::kDarkSteel,
                   onAxis(plan, plan.shafts[0].x, 0.0), plan.shafts[0].radiansPerSecond);
}

/// Adds the fittings on the housing's front: plug, sight glass, plate.
void addFittings(Assembly& assembly, const GearboxPlan& plan) {
  const auto onFront = [&](double x, double z) {
    return glm::translate(onAxis(plan, x, -kHalfOutside), {0.0, z - plan.axisHeight, 0.0});
  };
  const double between = 0.5 * (plan.shafts[1].x + plan.shafts[2].x);
  assembly.addPart("oil_plug", hexHead(0.009, 0.006), Finish::kBrass,
                   onFront(plan.right - 0.006, 0.013));
  const std::array<glm::dvec2, 6> ring{{{0.0040, 0.0},
                                        {0.0066, 0.0},
                                        {0.0066, 0.0022},
                                        {0.0058, 0.0030},
                                        {0.0046, 0.0030},
                                        {0.0040, 0.0024}}};
  assembly.addPart("sight_glass_ring", turned(ring, true, 32), Finish::kBrass,
                   onFront(between, 0.022));
  const std::array<glm::dvec2, 4> glass{
      {{0.0, 0.0}, {0.0042, 0.0}, {0.0042, 0.0016}, {0.0, 0.0019}}};
  assembly.addPart("sight_glass", turned(glass, false, 32), Finish::kGlass,
                   onFront(between, 0.022));
  const double plate = 0.5 * (plan.shafts[0].x + plan.shafts[1].x);
  assembly.addPart("name_plate",
                   bevelledBox({-0.013, -0.006, -0.0005}, {0.013, 0.006, 0.0010}, 0.0003),
                   Finish::kBrass, onFront(plate, 0.018));
}

void addTop(Assembly& assembly, const GearboxPlan& plan, bool isClosed) {
  if (isClosed) {
    assembly.addPart("cover", coverMesh(plan), Finish::kCastIron, kAsIs);
    const std::size_t head = assembly.addSurface(hexHead(0.0068, 0.0046), Finish::kDarkSteel);
    int number = 1;
    for (const glm::dmat4& place : flangeBolts(plan)) {
      assembly.addPart(fmt::format("cover_bolt_{}", number++), head,
                       glm::translate(place, {0.0, 0.0, kFlangeHeight + 0.0004}));
    }
    return;
  }
  const std::array<glm::dvec2, 5> section{
      {{0.0, -0.001}, {0.0020, -0.001}, {0.0020, 0.0112}, {0.0014, 0.0120}, {0.0, 0.0120}}};
  const std::size_t stud = assembly.addSurface(turned(section, false, 16), Finish::kSteel);
  int number = 1;
  for (const glm::dmat4& place : flangeBolts(plan)) {
    assembly.addPart(fmt::format("stud_{}", number++), stud, place);
  }
}

}  // namespace

Model gearboxModel(const GearboxParameters& parameters) {
  const GearboxPlan plan = gearboxPlan(parameters);
  const double scale = parameters.lengthMetres / plan.length;
  Assembly assembly(glm::scale(glm::dmat4(1.0), glm::dvec3(scale)));
  assembly.addPart("housing", housingMesh(plan), Finish::kCastIron, kAsIs);
  addShafts(assembly, plan);
  addGears(assembly, plan);
  addBearings(assembly, plan);
  std::vector<glm::dmat4> smallBolts;
  addEndCovers(assembly, plan, smallBolts);
  addBolts(assembly, plan, smallBolts);
  addCouplingBolts(assembly, plan);
  addFittings(assembly, plan);
  addTop(assembly, plan, parameters.isClosed);
  return assembly.take();
}

}  // namespace pleinair::scene
