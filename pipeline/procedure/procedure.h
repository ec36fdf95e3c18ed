#pragma once

#include <chrono>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/scene/description/model_source.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::procedure {

/// A text in each of the procedure's languages, by language ("en", "pt-BR").
using Translations = std::map<std::string, std::string>;

/// Signal words of warnings, most serious first (ANSI Z535.6, ISO 3864-2).
enum class WarningLevel { kDanger, kWarning, kCaution, kNotice };
std::string_view nameOf(WarningLevel level);

struct Warning {
  std::string id;
  int line = 0;  ///< in the TOML file
  WarningLevel level = WarningLevel::kWarning;
  Translations text;
};

struct Tool {
  std::string id;
  int line = 0;  ///< in the TOML file
  Translations name;
};

/// A tightening torque. The text is the author's ("25 ± 2 Nm"); the numbers are in newton metres.
struct Torque {
  std::string text;
  double newtonMetres = 0.0;
  double toleranceNewtonMetres = 0.0;
};

enum class CheckKind {
  kYesNo,   ///< a question
  kValue,   ///< a measured value within limits
  kPhoto,   ///< a still is taken
  kCompare  ///< a still is compared with a template
};
std::string_view nameOf(CheckKind kind);

/// How a step ended. Each kind of check has outcomes of its own; kDone is that of a step without.
enum class Outcome { kDone, kYes, kNo, kOk, kLow, kHigh, kTaken, kPass, kFail, kUncertain };
std::string_view nameOf(Outcome outcome);
std::optional<Outcome> outcomeNamed(std::string_view name);

/// The outcomes of a step, the one that leads on first. `kind`: nothing for a step without check.
std::vector<Outcome> outcomesOf(std::optional<CheckKind> kind);

struct Check {
  CheckKind kind = CheckKind::kYesNo;
  std::string unit;           ///< of a value
  std::optional<double> min;  ///< of a value, in `unit`; at least one limit is set
  std::optional<double> max;
  std::string comparison;  ///< the template's file, in the procedure's folder
};

/// What an arrow shows at the parts that a step moves, or else at its parts.
enum class Motion {
  kDefault,  ///< pull where it removes parts, push where it fits some, else none
  kNone,
  kPull,
  kPush,
  kTurn,
  kScrew,   ///< clockwise about the step's axis, as seen from its end
  kUnscrew  ///< counter-clockwise
};
/// How a part is shown in a step, where that is to differ from what follows from the step.
enum class PartView { kPlain, kFocus, kTint, kOutline, kHidden, kGhost };

/// Where a step leads.
inline constexpr std::size_t kEnd = std::numeric_limits<std::size_t>::max();

struct StepPicture {
  std::string file;  ///< in the procedure's folder
  std::string caption;
};

/// A movie of a step, without sound, that plays again and again.
struct StepMovie {
  std::string file;     ///< in the procedure's folder
  hal::FrameSize size;  ///< upright, with square pixels
};
/// The longest movie that is taken: all of it is in memory while its step is shown.
inline constexpr std::chrono::seconds kMostMovie{15};
/// The largest movie file.
inline constexpr std::uintmax_t kMostMovieFileBytes = std::uintmax_t{64} << 20U;
/// The longer side of a movie or picture, in shorter ones: it stands beside text.
inline constexpr int kMostSlender = 4;

/// A step in one language.
struct StepText {
  std::string title;
  std::string body;      ///< Markdown
  std::string question;  ///< of its check
  std::vector<StepPicture> pictures;
};

/// Parts are indices in Model::parts, rising.
struct Step {
  std::string id;
  int line = 0;                       ///< in the TOML file
  std::vector<std::size_t> parts;     ///< in focus
  std::vector<std::size_t> removes;   ///< taken off in this step, and not drawn after it
  std::vector<std::size_t> fits;      ///< put back in this step
  std::vector<std::size_t> tools;     ///< indices in Procedure::tools
  std::vector<std::size_t> warnings;  ///< indices in Procedure::warnings
  Motion motion = Motion::kDefault;
  /// Along or around which its parts move, in the frame of each: x, y or z, or the opposite of one.
  glm::dvec3 axis{0.0, 0.0, 1.0};
  std::vector<std::pair<std::size_t, PartView>> views;  ///< by part, in the file's order
  /// An exploded view: parts that are also shown at a distance along the axis (metres).
  std::vector<std::pair<std::size_t, double>> apart;
  std::optional<Torque> torque;
  std::optional<StepMovie> movie;
  std::optional<Check> check;
  /// The next step (index, or kEnd) by outcome. An outcome that is missing keeps the step.
  std::map<Outcome, std::size_t> next;
  std::map<std::string, StepText> text;  ///< by language

  /// The check's kind; nothing without check.
  std::optional<CheckKind> checkKind() const {
    return check ? std::optional(check->kind) : std::nullopt;
  }
};

/// A work instruction. A value; immutable once read, so any thread may read it.
struct Procedure {
  std::string name;
  std::string version;
  std::vector<std::string> languages;  ///< at least one; the first is the default
  Translations title;
  std::vector<Tool> tools;
  std::vector<Warning> warnings;
  std::vector<Step> steps;  ///< at least one; the first is where it begins
  scene::ModelSource source;
  std::shared_ptr<const scene::Model> model;
  double unitMetres = 1.0;  ///< of the model's lengths
  /// Rotates the model's axes so that z is up.
  glm::dmat3 uprightFromModel{1.0};
  /// Files of the folder that it was read from, relative to it, sorted.
  std::vector<std::string> files;
  /// SHA-256 over names and contents of `files`, in hexadecimal; empty if it came from no folder.
  std::string hash;

  /// The text of a step; of the default language if `language` is not one of the procedure's.
  const StepText& text(std::size_t step, const std::string& language) const;
  /// The index of the step with that id.
  std::optional<std::size_t> findStep(std::string_view id) const;
};

/// The translation, or that of the default language.
const std::string& translated(const Procedure& procedure, const Translations& text,
                              const std::string& language);

/// Markdown without its marks: emphasis and code signs go, "- " becomes a bullet, lines of a
/// paragraph are joined.
std::string plainText(std::string_view markdown);

/// The limits of a value for people: "0.08 … 0.25 mm", "≥ 0.08 mm".
std::string limitsText(const Check& check);

}  // namespace pleinair::procedure
