// What an overlay puts into a picture: crisp parts, outlines around them, labels and panels beside
// them.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <queue>

#include "pipeline/overlay/movie_player.h"
#include "pipeline/overlay/reserved_colours.h"
#include "pipeline/scene/models/limits.h"
#include "tests/gpu/overlay/overlay_fixture.h"
#include "tests/reports/overlay/bench_machine.h"
#include "tests/support/allocation_count.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{320, 240};

/// A step over one frame of the bench.
struct Shown {
  explicit Shown(const std::string& step, const std::string& style = "watercolor")
      : bench({.size = kSize, .shot = hal::SyntheticShot::kStill}, {0, 1, 2, 3, 4}),
        film({.folder = kGearboxProcedure, .step = step}, bench.scene) {
    painter = std::make_unique<Painter>(PainterOptions{.pictureSize = kSize,
                                                       .scene = bench.scene,
                                                       .style = style,
                                                       .readsSurfaces = true,
                                                       .overlay = true,
                                                       .machine = film.machine()});
    parameters.emplace(painter->defaultParameters());
    parameters->overlay = film.at(hal::Duration{0}, kSize);
  }

  /// Paints frames until the overlay is all there.
  Picture paint(int frames = 1) {
    Picture picture;
    for (int i = 0; i < frames; ++i) {
      picture = hal::orThrow(painter->paint(bench.next().first, *parameters));
    }
    return picture;
  }

  /// Whether a pixel shows a part with that look, by the id buffer.
  std::vector<bool> maskOf(overlay::PartLook look) const {
    const scene::SurfaceSnapshot surfaces = hal::orThrow(painter->surfaces());
    const scene::Model& model = *bench.scene.models[film.machine()].model;
    std::vector<bool> mask;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const std::uint32_t id = surfaces.id(x, y);
        bool isIn = id >> scene::kTriangleBits == 1;
        if (isIn) {
          const scene::ModelPart* part =
              scene::partOfTriangle(model, id & (scene::kMaxTriangles - 1));
          isIn = parameters->overlay->looks.at(
                     static_cast<std::size_t>(part - model.parts.data())) == look;
        }
        mask.push_back(isIn);
      }
    }
    return mask;
  }

  BenchMachine bench;
  app::ProcedureFilm film;
  std::unique_ptr<Painter> painter;
  std::optional<PaintParameters> parameters;  // set once there is a painter
};

std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kSize.width + static_cast<std::size_t>(x);
}

bool isColour(const hal::Image& image, int x, int y, const std::array<std::uint8_t, 3>& rgb) {
  const auto px = image.view().row(0, y).subspan(3 * static_cast<std::size_t>(x), 3);
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(int{px[c]} - int{rgb.at(c)}) > 6) return false;
  }
  return true;
}

bool isReserved(const hal::Image& image, int x, int y) {
  return isColour(image, x, y, overlay::kReservedRgb);
}

/// The step without what is not on the machine, and without what crosses the outline.
PaintParameters outlineOnly(const PaintParameters& parameters) {
  overlay::OverlayContent content = *parameters.overlay;
  content.panel = content.inset = {};
  content.labels.clear();
  content.arrows.clear();
  content.ghosts.clear();
  PaintParameters plain = parameters;
  plain.overlay = std::make_shared<const overlay::OverlayContent>(std::move(content));
  return plain;
}

TEST_F(OverlayTest, NoPaintIsOverThePartThatMatters) {
  Shown shown("coupling_off");
  shown.parameters = outlineOnly(*shown.parameters);
  ASSERT_EQ(shown.paint(3).overlay->trust.opacity, 1.0F);
  const hal::Image painted = hal::orThrow(shown.painter->snapshot());
  const hal::Image composed = hal::orThrow(shown.painter->composedSnapshot());
  const std::vector<bool> focus = shown.maskOf(overlay::PartLook::kFocus);
  ASSERT_GT(std::ranges::count(focus, true), 60);
  int differing = 0;
  int paintedElsewhere = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      const auto a = painted.view().row(0, y).subspan(3 * static_cast<std::size_t>(x), 3);
      const auto b = composed.view().row(0, y).subspan(3 * static_cast<std::size_t>(x), 3);
      const bool differs =
          std::abs(a[0] - b[0]) > 1 || std::abs(a[1] - b[1]) > 1 || std::abs(a[2] - b[2]) > 1;
      if (differs) ++(focus[at(x, y)] ? differing : paintedElsewhere);
    }
  }
  EXPECT_EQ(differing, 0);
  EXPECT_GT(paintedElsewhere, kSize.width * kSize.height / 4) << "the rest is painted";
}

TEST_F(OverlayTest, TheOutlineSurroundsThePartOfTheIdBuffer) {
  Shown shown("cover_off", "none");  // a large part: the share is not of a few pixels
  shown.parameters = outlineOnly(*shown.parameters);
  shown.paint(3);
  const hal::Image painted = hal::orThrow(shown.painter->snapshot());
  // What the outline keeps a flood from the picture's border out of, without the outline itself.
  std::vector<bool> isOutside(static_cast<std::size_t>(kSize.width * kSize.height));
  std::queue<std::pair<int, int>> open;
  open.emplace(0, 0);
  isOutside[0] = true;
  while (!open.empty()) {
    const auto [x, y] = open.front();
    open.pop();
    for (const auto& [u, v] : {std::pair(x + 1, y), {x - 1, y}, {x, y + 1}, {x, y - 1}}) {
      if (u < 0 || v < 0 || u >= kSize.width || v >= kSize.height) continue;
      if (isOutside[at(u, v)] || isReserved(painted, u, v)) continue;
      isOutside[at(u, v)] = true;
      open.emplace(u, v);
    }
  }
  const std::vector<bool> focus = shown.maskOf(overlay::PartLook::kFocus);
  int both = 0;
  int either = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      // In a hole of the part the flood does not reach the outline's outer edge.
      const bool isMark = isReserved(painted, x, y) || isColour(painted, x, y, overlay::kCasingRgb);
      const bool isIn = !isOutside[at(x, y)] && !isMark;
      both += isIn && focus[at(x, y)] ? 1 : 0;
      either += isIn || focus[at(x, y)] ? 1 : 0;
    }
  }
  EXPECT_GE(static_cast<double>(both) / either, 0.99) << both << " of " << either;
}

TEST_F(OverlayTest, PartsThatAreOffAreNotThere) {
  Shown with("cover_off", "none");
  with.paint(2);
  EXPECT_GT(std::ranges::count(with.maskOf(overlay::PartLook::kFocus), true), 500) << "the cover";
  EXPECT_EQ(std::ranges::count(with.maskOf(overlay::PartLook::kHidden), true), 0) << "its bolts";
  Shown without("as_found", "none");
  without.paint(2);
  EXPECT_EQ(std::ranges::count(without.maskOf(overlay::PartLook::kHidden), true), 0);
  EXPECT_GT(std::ranges::count(without.maskOf(overlay::PartLook::kFocus), true), 200)
      << "gears that the cover hid";
}

TEST_F(OverlayTest, LabelsStandStillBeforeAStillScene) {
  Shown shown("coupling_off", "none");
  shown.paint(8);
  ASSERT_EQ(shown.painter->overlayLabels().size(), 1U);
  const glm::ivec2 first = shown.painter->overlayLabels()[0].topLeft;
  int moved = 0;
  for (int i = 0; i < 60; ++i) {
    shown.paint();
    const overlay::PlacedLabel label = shown.painter->overlayLabels()[0];
    EXPECT_TRUE(label.isShown);
    moved += label.topLeft != first ? 1 : 0;
  }
  EXPECT_EQ(moved, 0) << "of 60 frames with a noisy picture";
}

TEST_F(OverlayTest, AViewOfTheCameraHasNoOverlay) {
  Shown shown("coupling_off", "none");
  shown.parameters->view = "camera";
  const Picture picture = shown.paint(2);
  EXPECT_FALSE(picture.overlay);
  const hal::Image raw = hal::orThrow(shown.painter->snapshot());
  int reserved = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) reserved += isReserved(raw, x, y) ? 1 : 0;
  }
  EXPECT_EQ(reserved, 0);
}

TEST_F(OverlayTest, SteadyFramesAllocateNothing) {
  Shown shown("cover_bolts_off", "none");
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < 16; ++i) frames.push_back(shown.bench.next().first);
  const auto paint = [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      (void)shown.painter->paint(frames[i], *shown.parameters);
  };
  paint(0, 8);
  EXPECT_EQ(support::allocationsIn([&] { paint(8, 16); }), 0) << support::allocationSites();
}

TEST_F(OverlayTest, AMoviePlaysInThePanelAgainAndAgainWithoutAllocating) {
  // Without a machine the panel stays at the lower edge.
  BenchMachine bench({.size = kSize, .shot = hal::SyntheticShot::kStill}, {0});
  app::ProcedureFilm film({.folder = kGearboxProcedure, .step = "drain"}, bench.scene);
  Painter painter({.pictureSize = kSize, .style = "none", .overlay = true});
  PaintParameters parameters = painter.defaultParameters();
  overlay::OverlayContent content = *film.at(hal::Duration{0}, kSize);
  constexpr hal::FrameSize kMovie{30, 20};
  overlay::PanelMovie movie{.frames = {}, .length = std::chrono::milliseconds(200)};
  const auto greyOf = [](std::size_t frame) { return static_cast<std::uint8_t>(60 + 50 * frame); };
  for (std::size_t i = 0; i < 4; ++i) {
    movie.frames.push_back(
        {.begins = i * std::chrono::milliseconds(50),
         .image = hal::Image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kMovie})});
    std::ranges::fill(movie.frames.back().image.plane(0), greyOf(i));
  }
  content.movie = std::make_shared<const overlay::PanelMovie>(std::move(movie));
  content.moviePlace = {.topLeft = {120, 8}, .size = {60, 40}};  // twice as large
  parameters.overlay = std::make_shared<const overlay::OverlayContent>(content);
  const int top = kSize.height - content.panel.size().height;
  const int left = content.moviePlace.topLeft.x;
  std::vector<hal::CapturedFrame> frames;
  for (int i = 0; i < 24; ++i) frames.push_back(bench.next().first);
  const hal::TimePoint began = frames.front().captureTime;
  std::vector<bool> isShown(4);
  hal::Image before;
  for (int i = 0; i < 12; ++i) {
    hal::orThrow(painter.paint(frames[i], parameters));
    const hal::Image painted = hal::orThrow(painter.snapshot());
    const std::size_t frame = overlay::frameAt(*content.movie, frames[i].captureTime - began);
    isShown[frame] = true;
    const auto pxAt = [&](const hal::Image& image, int x, int y) {
      return int{image.view().row(0, top + content.moviePlace.topLeft.y + y)[3 * (left + x)]};
    };
    EXPECT_NEAR(pxAt(painted, 0, 0), greyOf(frame), 2) << i;
    EXPECT_NEAR(pxAt(painted, 59, 39), greyOf(frame), 2) << i;
    if (i > 0) {
      // beside it: the camera's noise through the panel
      EXPECT_NEAR(pxAt(painted, -1, 20), pxAt(before, -1, 20), 5);
      EXPECT_NEAR(pxAt(painted, 60, 20), pxAt(before, 60, 20), 5);
    }
    before = painted;
  }
  EXPECT_EQ(isShown, std::vector<bool>(4, true));
  EXPECT_EQ(support::allocationsIn([&] {
              for (std::size_t i = 12; i < 24; ++i) {
                (void)painter.paint(frames[i], parameters);
              }
            }),
            0)
      << support::allocationSites();
}

TEST_F(OverlayTest, WithoutAMachineThereIsTheInstruction) {
  BenchMachine bench({.size = kSize, .shot = hal::SyntheticShot::kStill}, {0});
  app::ProcedureFilm film({.folder = kGearboxProcedure, .step = "drain"}, bench.scene);
  Painter painter({.pictureSize = kSize, .style = "none", .overlay = true});
  PaintParameters parameters = painter.defaultParameters();
  parameters.overlay = film.at(hal::Duration{0}, kSize);
  const Picture picture = hal::orThrow(painter.paint(bench.next().first, parameters));
  EXPECT_TRUE(picture.overlay->trust.standsIn);
  const hal::Image painted = hal::orThrow(painter.snapshot());
  int reserved = 0;
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) reserved += isReserved(painted, x, y) ? 1 : 0;
  }
  EXPECT_GT(reserved, 200) << "the step's number, and the parts in the inset";
}

}  // namespace
}  // namespace pleinair
