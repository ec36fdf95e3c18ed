#include "pipeline/procedure/words.h"

namespace pleinair::procedure {
namespace {

constexpr Words kEnglish{.step = "Step",
                         .tools = "Tools",
                         .torque = "Torque",
                         .check = "Check",
                         .end = "end",
                         .photo = "Take a photo",
                         .comparison = "Compare with the picture",
                         .yes = "yes",
                         .no = "no",
                         .ok = "within limits",
                         .low = "too low",
                         .high = "too high",
                         .pass = "pass",
                         .fail = "fail",
                         .uncertain = "uncertain",
                         .done = "done",
                         .danger = "DANGER",
                         .warning = "WARNING",
                         .caution = "CAUTION",
                         .notice = "NOTICE"};
// The signal words of DIN EN 82079-1.
constexpr Words kGerman{.step = "Schritt",
                        .tools = "Werkzeug",
                        .torque = "Drehmoment",
                        .check = "Prüfung",
                        .end = "Ende",
                        .photo = "Foto aufnehmen",
                        .comparison = "Mit dem Bild vergleichen",
                        .yes = "ja",
                        .no = "nein",
                        .ok = "im Bereich",
                        .low = "zu klein",
                        .high = "zu groß",
                        .pass = "bestanden",
                        .fail = "nicht bestanden",
                        .uncertain = "unklar",
                        .done = "erledigt",
                        .danger = "GEFAHR",
                        .warning = "WARNUNG",
                        .caution = "VORSICHT",
                        .notice = "HINWEIS"};

}  // namespace

const Words& wordsIn(std::string_view language) {
  return language.substr(0, language.find('-')) == "de" ? kGerman : kEnglish;
}

std::string_view wordOf(const Words& words, Outcome outcome) {
  switch (outcome) {
    case Outcome::kDone:
    case Outcome::kTaken:
      return words.done;
    case Outcome::kYes:
      return words.yes;
    case Outcome::kNo:
      return words.no;
    case Outcome::kOk:
      return words.ok;
    case Outcome::kLow:
      return words.low;
    case Outcome::kHigh:
      return words.high;
    case Outcome::kPass:
      return words.pass;
    case Outcome::kFail:
      return words.fail;
    case Outcome::kUncertain:
      return words.uncertain;
  }
  return {};
}

std::string_view wordOf(const Words& words, WarningLevel level) {
  switch (level) {
    case WarningLevel::kDanger:
      return words.danger;
    case WarningLevel::kWarning:
      return words.warning;
    case WarningLevel::kCaution:
      return words.caution;
    case WarningLevel::kNotice:
      return words.notice;
  }
  return {};
}

}  // namespace pleinair::procedure
