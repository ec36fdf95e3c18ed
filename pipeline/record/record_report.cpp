#include "pipeline/record/record_report.h"

#include <utility>
#include <variant>

#include <fmt/format.h>

#include "hal/html_text.h"
#include "hal/overloaded.h"
#include "pipeline/procedure/words.h"

namespace pleinair::record {
namespace {

using hal::htmlText;

/// For a path in a link: what could end it or be taken for a scheme is coded.
std::string linkTo(std::string_view path) {
  std::string link;
  for (const char c : path) {
    const bool isPlain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                         (c >= '0' && c <= '9') || c == '/' || c == '.' || c == '-' || c == '_';
    link += isPlain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return link;
}

std::string durationText(std::chrono::milliseconds time) {
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(time).count();
  return seconds < 60 ? fmt::format("{} s", seconds)
                      : fmt::format("{} min {:02} s", seconds / 60, seconds % 60);
}

/// "seen, ± 0.8 mm, 0.31 px"
std::string poseText(const PoseQuality& pose) {
  std::string text = pose.source == "none" ? "not located" : htmlText(pose.source);
  if (pose.sigmaMillimetres) text += fmt::format(", ± {:.1f} mm", *pose.sigmaMillimetres);
  if (pose.rmsPx) text += fmt::format(", {:.2f} px", *pose.rmsPx);
  return text;
}

constexpr std::string_view kStyle = R"(
@page { size: A4; margin: 18mm 15mm; }
body { font: 10pt/1.35 sans-serif; color: #111; max-width: 180mm; margin: 0 auto; padding: 4mm; }
h1 { font-size: 16pt; margin: 0 0 2mm; }
table { border-collapse: collapse; width: 100%; margin: 3mm 0; }
th, td { text-align: left; vertical-align: top; padding: 1mm 2mm; border-bottom: .2mm solid #bbb; }
thead { display: table-header-group; }
tr, figure { break-inside: avoid; }
.head th { width: 40mm; font-weight: normal; color: #555; }
.good { border: .5mm solid #187a2f; padding: 2mm; }
.bad { border: .5mm solid #b01010; padding: 2mm; font-weight: bold; }
.failed td { background: #f6e3e3; }
.day td { color: #555; padding-top: 3mm; }
.hash { font: 8pt monospace; overflow-wrap: anywhere; }
.stills { break-before: avoid; }
figure { display: inline-block; width: 46mm; margin: 1mm 2mm 1mm 0; }
figure img { width: 100%; border: .2mm solid #bbb; }
figcaption { font-size: 8pt; color: #555; }
)";

class Report {
 public:
  Report(const RecordReading& reading, const procedure::Procedure* procedure)
      : reading_(reading), procedure_(procedure) {}

  std::string make() {
    if (!reading_.entries.empty()) {
      begun_ = std::get_if<Begun>(&reading_.entries.front().event);
      for (const RecordEntry& entry : reading_.entries) add(entry);
      addFigures();
    }
    const std::string title = begun_ != nullptr ? htmlText(begun_->procedure) : "Record";
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"{}\">\n<head>\n<meta charset=\"utf-8\">\n<title>{}</title>\n"
        "<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n{}{}{}</body>\n</html>\n",
        begun_ != nullptr ? htmlText(begun_->language) : "en", title, kStyle, titleText(),
        headText(), verdictText(), stepsText());
  }

 private:
  std::string titleText() const {
    if (begun_ == nullptr) return "Record";
    if (procedure_ != nullptr) {
      return htmlText(translated(*procedure_, procedure_->title, begun_->language));
    }
    return htmlText(begun_->procedure);
  }

  static std::string row(std::string_view key, const std::string& value) {
    return value.empty() ? ""
                         : fmt::format("<tr><th>{}</th><td>{}</td></tr>\n", key, htmlText(value));
  }

  std::string headText() const {
    if (begun_ == nullptr) return {};
    const RecordEntry& first = reading_.entries.front();
    const RecordEntry& last = reading_.entries.back();
    std::string text = "<table class=\"head\">\n";
    text += row("Procedure", begun_->procedure + ", version " + begun_->version);
    text += row("Work order", begun_->workOrder);
    text += row("Operator", begun_->operatorName);
    text += row("Began", wallText(first.moment.wall) +
                             (first.moment.isClockTrusted ? "" : " (clock not synchronised)"));
    text += row("Last entry", wallText(last.moment.wall) +
                                  (last.moment.isClockTrusted ? "" : " (clock not synchronised)"));
    text += row("Program", begun_->program);
    text += fmt::format("<tr><th>Procedure, SHA-256</th><td class=\"hash\">{}</td></tr>\n",
                        htmlText(begun_->hash));
    text += fmt::format("<tr><th>Final hash</th><td class=\"hash\">{}</td></tr>\n</table>\n",
                        reading_.finalHash());
    return text;
  }

  std::string verdictText() const {
    if (reading_.findings.empty()) {
      const auto& signedOff = std::get<SignedOff>(reading_.entries.back().event);
      std::string text = fmt::format(
          "<p class=\"good\">Signed off as {} by {}. All {} lines and their stills are unchanged.",
          signedOff.result == SignOff::kCompleted ? "completed" : "<b>aborted</b>",
          htmlText(signedOff.operatorName), reading_.entries.size());
      if (!signedOff.remark.empty()) text += " Remark: " + htmlText(signedOff.remark);
      return text + "</p>\n" + notesText();
    }
    std::string text;
    for (const RecordFinding& finding : reading_.findings) {
      text += fmt::format("<p class=\"bad\">{}{}</p>\n",
                          finding.line > 0 ? fmt::format("Line {} ", finding.line) : "The record ",
                          htmlText(finding.problem));
    }
    return text + notesText();
  }

  std::string notesText() const {
    std::string text;
    for (const std::string& note : reading_.notes) {
      text += fmt::format("<p>Note: {}</p>\n", htmlText(note));
    }
    return text;
  }

  std::string stepsText() const {
    return "<table>\n<thead><tr><th>Time (UTC)</th><th>Event</th><th>Result</th><th>Took</th></tr>"
           "</thead>\n<tbody>\n" +
           rows_ + "</tbody>\n</table>\n";
  }

  std::string stepTitle(const std::string& id) const {
    if (procedure_ == nullptr) return htmlText(id);
    const auto step = procedure_->findStep(id);
    if (!step) return htmlText(id);
    return fmt::format("{}. {}", *step + 1,
                       htmlText(procedure_->text(*step, begun_->language).title));
  }

  /// A row of its own for each new day; times are short then.
  void addDay(const RecordEntry& entry) {
    constexpr std::size_t kDateDigits = 10;
    const std::string day = wallText(entry.moment.wall).substr(0, kDateDigits);
    if (std::exchange(day_, day) == day) return;
    rows_ += fmt::format("<tr class=\"day\"><td colspan=\"4\">{}</td></tr>\n", day);
  }

  /// The stills that no row shows yet, beside one another.
  void addFigures() {
    if (figures_.empty()) return;
    rows_ += fmt::format("<tr class=\"stills\"><td></td><td colspan=\"3\">{}</td></tr>\n",
                         std::exchange(figures_, {}));
  }

  void addRow(const RecordEntry& entry, const std::string& event, const std::string& result,
              const std::string& took = {}, bool isFailed = false) {
    constexpr std::size_t kTimeAt = 11;
    constexpr std::size_t kTimeDigits = 8;
    addDay(entry);
    rows_ +=
        fmt::format("<tr{}><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                    isFailed ? " class=\"failed\"" : "",
                    wallText(entry.moment.wall).substr(kTimeAt, kTimeDigits), event, result, took);
  }

  void addStep(const RecordEntry& entry, const StepDone& done) {
    const procedure::Words& words = procedure::wordsIn(begun_->language);
    std::string result(procedure::wordOf(words, done.outcome));
    if (done.value) result = fmt::format("{:g} {}: {}", *done.value, htmlText(done.unit), result);
    if (!done.by.empty()) result += ", compared by the " + htmlText(done.by);
    using procedure::Outcome;
    const bool isFailed = done.outcome == Outcome::kNo || done.outcome == Outcome::kLow ||
                          done.outcome == Outcome::kHigh || done.outcome == Outcome::kFail ||
                          done.outcome == Outcome::kUncertain;
    if (done.pose) {
      result += "<br>machine " + poseText(*done.pose);
    }
    addRow(entry, stepTitle(done.step), result, durationText(done.took), isFailed);
    addFigures();
  }

  void add(const RecordEntry& entry) {
    const bool isOfStep = std::holds_alternative<StillTaken>(entry.event) ||
                          std::holds_alternative<StepDone>(entry.event);
    if (!isOfStep) addFigures();  // of a step that was not ended
    std::visit(
        hal::Overloaded{
            [&](const Begun& each) { addRow(entry, "begun", htmlText(each.operatorName)); },
            [&](const StepDone& each) { addStep(entry, each); },
            [&](const SteppedBack& each) { addRow(entry, "back to " + stepTitle(each.next), ""); },
            [&](const StillTaken& each) {
              const std::string link = linkTo(each.file);
              figures_ += fmt::format(
                  "<figure><img src=\"{}\" alt=\"{}\"><figcaption>{}: {}</figcaption></figure>",
                  link, htmlText(each.file), htmlText(each.when), htmlText(each.file));
            },
            [&](const OperatorChanged& each) {
              addRow(entry, "operator", htmlText(each.operatorName));
            },
            [&](const ProcedureChanged& each) {
              addRow(entry, "procedure changed", "version " + htmlText(each.version));
            },
            [&](const Resumed& each) {
              addRow(entry, "resumed after an interruption",
                     each.cutBytes > 0
                         ? fmt::format("{} bytes of an unfinished line were cut", each.cutBytes)
                         : "");
            },
            [&](const SignedOff& each) {
              addRow(entry, "signed off", htmlText(each.operatorName));
            }},
        entry.event);
  }

  const RecordReading& reading_;
  const procedure::Procedure* procedure_;
  const Begun* begun_ = nullptr;
  std::string rows_;
  std::string day_;      ///< of the last row
  std::string figures_;  ///< of stills whose step has no row yet
};

}  // namespace

std::string htmlReport(const RecordReading& reading, const procedure::Procedure* procedure) {
  return Report(reading, procedure).make();
}

}  // namespace pleinair::record
