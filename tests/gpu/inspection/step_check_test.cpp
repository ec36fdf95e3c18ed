// Step checks over rendered parts of the gearbox that are as they should be, missing, turned, and
// under other light: nothing wrong may pass.
#include <array>
#include <cstdio>
#include <string>

#include "pipeline/inspection/part_inspection.h"
#include "tests/gpu/inspection/rendered_parts.h"
#include "tests/support/gl_test.h"

namespace pleinair {
namespace {

using inspection::Verdict;

constexpr double kPartMargin = 1.15;  // as live procedures have it
constexpr glm::dvec3 kAlong{0.0, 0.0, 1.0};
constexpr glm::dvec3 kAcross{1.0, 0.0, 0.0};

/// Beside the template's place.
constexpr std::array<glm::dvec2, 5> kBeside{{{2, 1}, {-4, 2}, {3, -3}, {-1, -4}, {5, 0}}};
constexpr std::array<double, 5> kTurnsDeg{12, 31, 50, 69, 88};

struct Tally {
  int pass = 0;
  int fail = 0;
  int uncertain = 0;
  void add(Verdict verdict) {
    pass += verdict == Verdict::kPass ? 1 : 0;
    fail += verdict == Verdict::kFail ? 1 : 0;
    uncertain += verdict == Verdict::kUncertain ? 1 : 0;
  }
};

struct Tallies {
  Tally correct, missing, turned, shaded;
};

Verdict verdictOfStill(const RenderedParts& parts, std::size_t index, const PartStill& expected,
                       const PartStill& still) {
  const app::PartSurface& surface = parts.surface(index);
  return inspection::inspectPart(expected.posed(), still.posed(),
                                 {.centre = surface.sphere.centre,
                                  .radiusMetres = kPartMargin * surface.sphere.radiusMetres,
                                  .triangles = surface.triangles})
      .verdict;
}

class StepCheckTest : public support::GlTest {
 protected:
  /// 20 stills of each part.
  static Tallies inspectAll(std::span<const CheckedPart> checked) {
    RenderedParts parts(checked);
    Tallies tallies;
    for (std::size_t i = 0; i < checked.size(); ++i) {
      const PartStill expected = parts.templateOf(i);
      for (std::size_t view = 0; view < kBeside.size(); ++view) {
        const auto inspect = [&](const PartState& state) {
          const auto seed = static_cast<unsigned>(100 * i + view);
          const PartStill still =
              parts.still(i, state, kBeside.at(view).x, kBeside.at(view).y, seed);
          return verdictOfStill(parts, i, expected, still);
        };
        tallies.correct.add(inspect({}));
        tallies.missing.add(inspect({.isMissing = true}));
        tallies.turned.add(inspect({.turnedDeg = kTurnsDeg.at(view)}));
        tallies.shaded.add(inspect({.isShaded = true}));
      }
    }
    const auto print = [](const char* what, const Tally& tally) {
      std::printf("%-8s pass %2d  fail %2d  uncertain %2d\n", what, tally.pass, tally.fail,
                  tally.uncertain);
    };
    print("correct", tallies.correct);
    print("missing", tallies.missing);
    print("turned", tallies.turned);
    print("shaded", tallies.shaded);
    return tallies;
  }
};

void expectNothingWrongPasses(const Tallies& tallies) {
  EXPECT_EQ(tallies.missing.pass + tallies.turned.pass, 0);
  EXPECT_EQ(tallies.correct.pass, 25);
  EXPECT_LE(tallies.correct.uncertain + tallies.missing.uncertain + tallies.turned.uncertain +
                tallies.shaded.uncertain,
            10);
}

TEST_F(StepCheckTest, NothingWrongPassesAmongAHundredStills) {
  const std::array<CheckedPart, 5> parts{{{"output_key", kAlong},
                                          {"name_plate", kAlong},
                                          {"oil_plug", kAcross},
                                          {"cover_bolt_3", kAcross},
                                          {"input_coupling", kAcross}}};
  const Tallies tallies = inspectAll(parts);
  expectNothingWrongPasses(tallies);
  EXPECT_EQ(tallies.shaded.fail, 0);
}

TEST_F(StepCheckTest, NorOfPartsThatThresholdsWereNotChosenOn) {
  const std::array<CheckedPart, 5> parts{{{"bolt_13", kAcross},
                                          {"sight_glass_ring", kAcross},
                                          {"end_cover_3", kAcross},
                                          {"coupling_bolts", kAlong},
                                          {"cover", kAcross}}};
  const Tallies tallies = inspectAll(parts);
  expectNothingWrongPasses(tallies);
  EXPECT_LE(tallies.shaded.fail, 3);
}

/// The control: the template decides what is right, not the picture's quality.
TEST_F(StepCheckTest, WhereTheTemplateHasNoPartThePartIsWrong) {
  const std::array<CheckedPart, 2> checked{{{"oil_plug", kAcross}, {"cover", kAcross}}};
  RenderedParts parts(checked);
  for (std::size_t i = 0; i < checked.size(); ++i) {
    const PartStill without = parts.still(i, {.isMissing = true}, 0.0, 0.0, 1);
    const auto verdictOf = [&](const PartState& state) {
      return verdictOfStill(parts, i, without, parts.still(i, state, 1.0, 1.0, 2));
    };
    EXPECT_NE(verdictOf({}), Verdict::kPass) << checked.at(i).name;
    EXPECT_NE(verdictOf({.isMissing = true}), Verdict::kFail) << checked.at(i).name;
  }
}

}  // namespace
}  // namespace pleinair
