#include "tests/reports/overlay/truth_film.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::overlay_truth {
namespace {

/// The true error at a step's parts: the farthest of their centres in the image.
double trueErrorPx(const BenchMachine& bench, const std::vector<overlay::PartShape>& parts,
                   const glm::dmat4& drawn, const glm::dmat4& truth) {
  double worst = 0.0;
  for (const overlay::PartShape& part : parts) {
    const glm::dvec3 is(drawn * glm::dvec4(part.centre, 1.0));
    const glm::dvec3 should(truth * glm::dvec4(part.centre, 1.0));
    if (is.z <= 0.0 || should.z <= 0.0) return HUGE_VAL;
    worst = std::max(
        worst, glm::length(bench.scene.camera->project(is) - bench.scene.camera->project(should)));
  }
  return worst;
}

/// Frames of the bench; the camera rests now and then.
class RestingFrames {
 public:
  RestingFrames(BenchMachine& bench, const Film& film) : bench_(bench), film_(film) {}

  struct Shown {
    hal::CapturedFrame frame;
    std::shared_ptr<hal::Image> image;
    std::uint64_t truth = 0;  ///< sequence number of the frame whose truth it has
  };

  Shown next() {
    if (film_.rests > 0 && moved_ == film_.moves && rested_ < film_.rests) {
      ++rested_;
      return copyOf(last_);
    }
    if (moved_ == film_.moves) moved_ = rested_ = 0;
    ++moved_;
    auto [frame, image] = bench_.next();
    last_ = {.frame = frame, .image = image, .truth = frame.sequence};
    return copyOf(last_);
  }

 private:
  /// A frame of its own, at the time of the number that it gets.
  Shown copyOf(const Shown& from) {
    Shown shown = from;
    shown.image = std::make_shared<hal::Image>(from.frame.image);
    shown.frame.image = shown.image->view();
    shown.frame.lease = shown.image;
    if (film_.rests == 0) return shown;
    if (!first_) first_ = from.frame;
    shown.frame.sequence = first_->sequence + given_;
    shown.frame.captureTime = first_->captureTime + given_ * film_.options.framePeriod;
    ++given_;
    return shown;
  }

  BenchMachine& bench_;
  const Film& film_;
  Shown last_;
  int moved_ = 0;
  int rested_ = 0;
  std::optional<hal::CapturedFrame> first_;
  std::uint64_t given_ = 0;
};

}  // namespace

std::vector<Moment> play(Film film) {
  film.options.size = kSize;
  film.options.framePeriod = std::chrono::milliseconds(50);
  BenchMachine bench(film.options, film.tags);
  if (film.author) film.author(bench.scene);
  app::ProcedureFilm steps({.folder = kGearboxProcedure, .step = "end_bolts_off"}, bench.scene);
  PainterOptions painting{.pictureSize = kSize,
                          .scene = bench.scene,
                          .style = "none",
                          .overlay = true,
                          .machine = steps.machine(),
                          .doubtfulTags = std::make_shared<overlay::DoubtfulTags>()};
  std::optional<Painter> painter(std::in_place, painting);
  PaintParameters parameters = painter->defaultParameters();
  auto content = std::make_shared<overlay::OverlayContent>(*steps.at(hal::Duration{0}, kSize));
  content->cards = film.cards;
  parameters.overlay = std::move(content);
  const scene::Model& model = *bench.scene.models[steps.machine()].model;
  std::vector<overlay::PartShape> parts;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (parameters.overlay->looks[i] == overlay::PartLook::kFocus) {
      parts.push_back(overlay::shapeOf(model, i));
    }
  }
  for (std::size_t i = 0; i < film.skipped; ++i) bench.next();
  RestingFrames frames(bench, film);
  std::vector<Moment> moments;
  for (int i = 0; i < film.frames; ++i) {
    const auto [frame, image, truth] = frames.next();
    if (film.change) film.change(bench, truth, *image);
    if (frame.sequence == film.painterAnewAt) {
      painter.reset();
      if (!film.keepsDoubts) painting.doubtfulTags.reset();
      painter.emplace(painting);
    }
    const Picture picture = hal::orThrow(painter->paint(frame, parameters));
    const auto drawn = bench.drawnCameraFromModel(picture.tracking);
    const bool isGone = film.goneFrom && frame.sequence >= *film.goneFrom;
    Moment moment{.errorPx = std::nullopt,
                  .predictedPx = picture.overlay->predictedErrorPx,
                  .opacity = picture.overlay->trust.opacity,
                  .doubt = picture.overlay->trust.doubt};
    if (drawn && !isGone) {
      const double error = trueErrorPx(bench, parts, *drawn, bench.trueCameraFromModel(truth));
      if (std::isfinite(error)) moment.errorPx = error;
    }
    moments.push_back(moment);
  }
  return moments;
}

Counts countsOf(const std::vector<Moment>& moments) {
  Counts counts;
  for (const Moment& each : moments) {
    ++counts.frames;
    counts.otherMachine += each.doubt == overlay::Doubt::kOtherMachine ? 1 : 0;
    if (each.isWrong()) {
      ++counts.wrong;
      counts.wrongAndShown += each.opacity > 0.0F ? 1 : 0;
    }
    if (each.opacity > 0.0F) {
      counts.worstShownPx = std::max(counts.worstShownPx, each.errorPx.value_or(HUGE_VAL));
    }
    if (!each.isRight()) continue;
    ++counts.right;
    const bool isShown = each.opacity >= 0.5F;
    counts.rightAndShown += isShown ? 1 : 0;
    if (isShown) continue;
    const bool isBack = each.opacity > 0.0F;
    const auto doubt = isBack ? overlay::Doubt::kNone : each.doubt;
    ++counts.hiddenBy.at(static_cast<std::size_t>(doubt));
  }
  return counts;
}

void cover(const BenchMachine& bench, std::uint64_t sequence, int tag, hal::Image& image) {
  const hal::GroundTruth truth = bench.camera.truth(sequence);
  for (const hal::TagTruth& each : truth.tags) {
    if (each.tag.id != tag) continue;
    glm::dvec2 low = each.cornersPx[0];
    glm::dvec2 high = low;
    for (const glm::dvec2& corner : each.cornersPx) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    const glm::dvec2 margin = 0.3 * (high - low);
    low -= margin;
    high += margin;
    for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(kSize.height, high.y);
         ++y) {
      const auto row = image.row(0, y);
      for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(kSize.width, high.x);
           ++x) {
        std::fill_n(row.begin() + 3 * x, 3, std::uint8_t{120});
      }
    }
  }
}

void showInstead(const BenchMachine& bench, std::uint64_t sequence, int from, int to,
                 hal::Image& image) {
  const hal::GroundTruth truth = bench.camera.truth(sequence);
  const auto cornersOf = [&](int tag) {
    std::vector<cv::Point2f> corners;
    for (const hal::TagTruth& each : truth.tags) {
      if (each.tag.id != tag) continue;
      for (const glm::dvec2& px : each.cornersPx) {
        // pixel centres at 0, as OpenCV has them
        corners.emplace_back(static_cast<float>(px.x - 0.5), static_cast<float>(px.y - 0.5));
      }
    }
    return corners;
  };
  const auto widened = [](std::vector<cv::Point2f> corners) {
    const cv::Point2f middle = 0.25F * (corners[0] + corners[1] + corners[2] + corners[3]);
    for (cv::Point2f& each : corners) each = middle + 1.2F * (each - middle);
    return corners;
  };
  const cv::Mat homography = cv::getPerspectiveTransform(cornersOf(from), cornersOf(to));
  cv::Mat whole(kSize.height, kSize.width, CV_8UC3, image.plane(0).data());
  cv::Mat moved;
  cv::warpPerspective(whole, moved, homography, whole.size());
  std::vector<cv::Point> area;
  for (const cv::Point2f& each : widened(cornersOf(to))) area.emplace_back(each);
  cv::Mat mask(whole.size(), CV_8UC1, cv::Scalar(0));
  cv::fillConvexPoly(mask, area, cv::Scalar(255));
  moved.copyTo(whole, mask);
}

std::vector<NamedFilm> truthFilms() {
  using hal::SyntheticShot;
  const auto covering = [](std::vector<int> tags, std::uint64_t from, std::uint64_t to) {
    return [tags, from, to](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
      for (const int tag : tags) {
        if (sequence >= from && sequence < to) cover(bench, sequence, tag, image);
      }
    };
  };
  constexpr std::uint64_t kSwapped = 16;
  const Change swaps = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    if (sequence >= kSwapped) showInstead(bench, sequence, 1, 0, image);
    for (const int tag : {1, 2, 3, 4}) cover(bench, sequence, tag, image);
  };
  const Change darkens = [](const BenchMachine&, std::uint64_t, hal::Image& image) {
    for (std::uint8_t& each : image.plane(0)) each = static_cast<std::uint8_t>(each / 8);
  };
  const hal::SyntheticOptions walk{.shot = SyntheticShot::kWalkaround};
  return {{"walkaround, five tags", {.options = walk, .tags = kAllTags}},
          {"walkaround, one tag, noise of 6 levels",
           {.options = {.shot = SyntheticShot::kWalkaround, .noiseSigma = 6.0},
            .tags = {0},
            .skipped = 60}},
          {"an arm reaches over the tags",
           {.options = {.shot = SyntheticShot::kOccluder},
            .tags = kAllTags,
            .frames = 60,
            .skipped = 20}},
          {"the machine's tag covered for 1.2 s",
           {.options = walk, .tags = {0}, .frames = 44, .change = covering({0}, 10, 34)}},
          {"all tags covered for 0.9 s",
           {.options = walk, .tags = {0}, .frames = 36, .change = covering(kAllTags, 10, 28)}},
          {"another machine's tag in the place of the machine's",
           {.options = walk, .tags = {0}, .change = swaps, .goneFrom = kSwapped}},
          {"low light: an eighth",
           {.options = {.shot = SyntheticShot::kWalkaround, .noiseSigma = 16.0},
            .tags = kAllTags,
            .change = darkens}},
          {"held poses: the camera rests for 0.6 s and goes on",
           {.options = walk, .tags = kAllTags, .frames = 80, .rests = 12}},
          {"held poses, one tag, covered for 0.7 s of a rest",
           {.options = walk,
            .tags = {0},
            .frames = 80,
            .change = covering(kAllTags, 23, 25),
            .rests = 12}}};
}

}  // namespace pleinair::overlay_truth
