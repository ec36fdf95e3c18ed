#include "tests/reports/tracking/cut_films.h"

#include <algorithm>
#include <functional>
#include <map>
#include <ostream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/motion/image_motion_estimator.h"

namespace pleinair::tracking {
namespace {

using hal::SyntheticShot;

/// The frames that are cuts, but for the first one.
std::vector<std::size_t> cutsIn(const Film& film) {
  ImageMotionEstimator estimator({.flow = false});
  std::vector<std::size_t> cuts;
  for (std::size_t i = 0; i < film.size(); ++i) {
    const hal::PlaneView plane{.bytes = {film[i].data, film[i].total()},
                               .strideBytes = static_cast<std::size_t>(film[i].step)};
    const bool isCut = estimator.follow(plane, {film[i].cols, film[i].rows}, i).isCut;
    if (isCut && i > 0) cuts.push_back(i);
  }
  return cuts;
}

struct FilmCase {
  std::string name;
  std::function<Film()> film;  // empty where its data is missing
  friend std::ostream& operator<<(std::ostream& out, const FilmCase& of) { return out << of.name; }
};

/// The first frames of a shot, rendered once; of kVisitors when one of them is in the picture.
const Film& bench(SyntheticShot shot) {
  static std::map<SyntheticShot, Film> films;
  Film& film = films[shot];
  constexpr std::size_t kFrames = 36;
  constexpr std::size_t kVisitorsCome = 45;
  if (film.empty()) {
    const bool waits = shot == SyntheticShot::kVisitors;
    film = workbench(shot, waits ? kVisitorsCome : 0, kFrames);
  }
  return film;
}

Film part(const Film& film, std::size_t count, std::size_t every = 1) {
  Film out;
  for (std::size_t i = 0; i < film.size() && out.size() < count; i += every) {
    out.push_back(film[i]);
  }
  return out;
}

std::string nameOf(const testing::TestParamInfo<FilmCase>& info) {
  return info.param.name;
}

// Films with a cut, which is frame kCutAt.
constexpr std::size_t kCutAt = 5;
constexpr std::size_t kAfter = 3;

using View = std::function<cv::Mat(const cv::Mat&)>;

View cropped(double x, double y, double part) {
  return [=](const cv::Mat& image) { return crop(image, x, y, part); };
}

View mirrored() {
  return [](const cv::Mat& image) {
    cv::Mat out;
    cv::flip(image, out, 1);
    return out;
  };
}

/// A film that goes on, seen in one way and then in another.
Film spliced(const Film& film, const View& before, const View& after) {
  Film out;
  for (std::size_t i = 0; i < film.size(); ++i) {
    out.push_back(noisy(i < kCutAt ? before(film[i]) : after(film[i]), static_cast<unsigned>(i)));
  }
  return out;
}

/// The same of two photographs, by cameras that stand.
Film spliced(const cv::Mat& before, const cv::Mat& after) {
  Film out;
  if (before.empty() || after.empty()) return out;
  for (std::size_t i = 0; i < kCutAt + kAfter; ++i) {
    out.push_back(noisy(i < kCutAt ? before : after, static_cast<unsigned>(i)));
  }
  return out;
}

std::vector<FilmCase> cutFilms() {
  std::vector<FilmCase> out;
  const View whole = cropped(0.0, 0.0, 1.0);
  const View close = cropped(0.19, 0.19, 0.62);
  struct Pair {
    const char* name;
    View before;
    View after;
  };
  const std::vector<Pair> pairs{
      {"WholeToClose", whole, close},
      {"CloseToWhole", close, whole},
      {"WholeToTwice", whole, cropped(0.25, 0.25, 0.5)},
      {"LeftToRightThird", cropped(0.0, 0.3, 0.34), cropped(0.66, 0.3, 0.34)},
      {"RightToLeftThird", cropped(0.66, 0.3, 0.34), cropped(0.0, 0.3, 0.34)},
      {"MovedByAThird", cropped(0.0, 0.1, 0.75), cropped(0.25, 0.1, 0.75)},
      {"MovedDownByAThird", cropped(0.1, 0.0, 0.75), cropped(0.1, 0.25, 0.75)},
      {"Mirrored", whole, mirrored()}};
  for (const Pair& pair : pairs) {
    for (const SyntheticShot shot : {SyntheticShot::kWalkaround, SyntheticShot::kVisitors}) {
      out.push_back({std::string(toString(shot)) + pair.name, [shot, pair] {
                       return spliced(part(bench(shot), kCutAt + kAfter), pair.before, pair.after);
                     }});
    }
  }
  out.push_back({"walkaroundToVisitors", [] {
                   Film film = part(bench(SyntheticShot::kWalkaround), kCutAt);
                   const Film then = part(bench(SyntheticShot::kVisitors), kAfter);
                   film.insert(film.end(), then.begin(), then.end());
                   return film;
                 }});
  // The synthetic camera's own cuts: the same bench from other places.
  for (const std::size_t second : {2U, 4U, 6U}) {
    out.push_back({"cutAfter" + std::to_string(second) + "s", [second] {
                     return workbench(SyntheticShot::kCut, 30 * second + 1 - kCutAt,
                                      kCutAt + kAfter);
                   }});
  }
  struct Photos {
    const char* name;
    const char* before;
    const char* after;
  };
  for (const Photos& each : {Photos{"brickToGrass", "brick.png", "grass.png"},
                             Photos{"coffeeToCoins", "coffee.png", "coins.png"},
                             Photos{"retinaToRocket", "retina.jpg", "rocket.jpg"}}) {
    out.push_back({each.name, [each] { return spliced(photo(each.before), photo(each.after)); }});
  }
  for (const char* const name : {"brick.png", "grass.png", "coins.png", "page.png", "rocket.jpg"}) {
    const std::string stem(name, std::string(name).find('.'));
    out.push_back({stem + "LeftToRight", [name] {
                     const cv::Mat image = photo(name);
                     if (image.empty()) return Film{};
                     return spliced(crop(image, 0.0, 0.2, 0.5), crop(image, 0.5, 0.3, 0.5));
                   }});
  }
  return out;
}

class FilmWithACut : public testing::TestWithParam<FilmCase> {};
INSTANTIATE_TEST_SUITE_P(Films, FilmWithACut, testing::ValuesIn(cutFilms()), nameOf);

TEST_P(FilmWithACut, IsCutAtThatFrameOnly) {
  const Film film = GetParam().film();
  if (film.empty()) GTEST_SKIP() << "no photographs in " PLEINAIR_SHARED_DATA;
  ASSERT_EQ(film.size(), kCutAt + kAfter);
  EXPECT_EQ(cutsIn(film), std::vector<std::size_t>{kCutAt});
}

// Films without a cut.

/// A camera that stands, and whose picture `change` changes from frame to frame.
Film changing(const cv::Mat& image, const std::function<void(cv::Mat&, int)>& change) {
  Film out;
  for (int i = 0; i < 20; ++i) {
    cv::Mat each = image.clone();
    change(each, i);
    out.push_back(noisy(each, static_cast<unsigned>(i)));
  }
  return out;
}

void lightFallsAway(cv::Mat& m, int i) {
  if (i >= 8) m.convertTo(m, -1, 0.35, 0.0);
}
void lampComesOn(cv::Mat& m, int i) {
  if (i < 8) return;
  for (int y = 0; y < m.rows; ++y) {
    for (int x = 0; x < m.cols; ++x) {
      auto& px = m.at<unsigned char>(y, x);
      px = cv::saturate_cast<unsigned char>(px * (0.5 + 1.8 * x / m.cols));
    }
  }
}
void overexposedFlash(cv::Mat& m, int i) {
  if (i == 8) m.convertTo(m, -1, 1.6, 90.0);
}
void whiteFrame(cv::Mat& m, int i) {
  if (i == 8) m.setTo(250);
}
void blackFrames(cv::Mat& m, int i) {
  if (i >= 8 && i < 13) m.setTo(12);
}
void cover(cv::Mat& m, int width) {
  cv::Mat hand = m(cv::Rect(0, 0, std::clamp(width, 1, m.cols), m.rows));
  for (int y = 0; y < hand.rows; ++y) {
    for (int x = 0; x < hand.cols; ++x) {
      hand.at<unsigned char>(y, x) =
          static_cast<unsigned char>(100 + 50 * x / m.cols - 30 * y / m.rows);
    }
  }
}
void armComesIn(cv::Mat& m, int i) {
  if (i >= 4) cover(m, std::min(420, 110 * (i - 3)));
}
void handCoversTheLens(cv::Mat& m, int i) {
  if (i >= 6 && i <= 14) cover(m, 160 * (std::min(i, 20 - i) - 5));
}

std::vector<FilmCase> uncutFilms() {
  std::vector<FilmCase> out;
  for (const std::string_view name : hal::syntheticShots()) {
    const SyntheticShot shot = *hal::syntheticShotNamed(name);
    if (shot == SyntheticShot::kCut) continue;
    out.push_back({std::string(name), [shot] { return bench(shot); }});
    out.push_back({std::string(name) + "EveryThird", [shot] { return part(bench(shot), 12, 3); }});
  }
  struct Change {
    const char* name;
    void (*change)(cv::Mat&, int);
  };
  const std::vector<Change> changes{{"LightFallsAway", lightFallsAway},
                                    {"LampComesOn", lampComesOn},
                                    {"Flash", overexposedFlash},
                                    {"WhiteFrame", whiteFrame},
                                    {"BlackFrames", blackFrames},
                                    {"ArmComesIn", armComesIn},
                                    {"HandCoversTheLens", handCoversTheLens}};
  const std::vector<std::pair<std::string, std::function<cv::Mat()>>> pictures{
      {"walkaround", [] { return bench(SyntheticShot::kWalkaround).front(); }},
      {"visitors", [] { return bench(SyntheticShot::kVisitors).front(); }},
      {"brick", [] { return photo("brick.png"); }},
      {"rocket", [] { return photo("rocket.jpg"); }}};
  for (const auto& [name, picture] : pictures) {
    for (const Change& change : changes) {
      out.push_back({name + change.name, [picture, change] {
                       const cv::Mat image = picture();
                       return image.empty() ? Film{} : changing(image, change.change);
                     }});
    }
    for (const int step : {20, 60, 90}) {
      for (const bool blurs : {false, true}) {
        out.push_back({name + "PanOf" + std::to_string(step) + (blurs ? "Blurred" : ""),
                       [picture, step, blurs] {
                         const cv::Mat image = picture();
                         return image.empty() ? Film{} : panOver(image, step, blurs);
                       }});
      }
    }
  }
  return out;
}

class FilmWithoutACut : public testing::TestWithParam<FilmCase> {};
INSTANTIATE_TEST_SUITE_P(Films, FilmWithoutACut, testing::ValuesIn(uncutFilms()), nameOf);

TEST_P(FilmWithoutACut, HasNone) {
  const Film film = GetParam().film();
  if (film.empty()) GTEST_SKIP() << "no photographs in " PLEINAIR_SHARED_DATA;
  EXPECT_EQ(cutsIn(film), std::vector<std::size_t>{});
}

}  // namespace
}  // namespace pleinair::tracking
