#include <algorithm>

#include <fmt/format.h>

#include "pipeline/measure/report.h"

namespace pleinair::measure {
namespace {

constexpr int kNameWidth = 28;
constexpr int kColumnWidth = 8;

std::string row(const std::string& name, const Measures& measures) {
  std::string line = fmt::format("{:<{}}", name, kNameWidth);
  for (const MeasureColumn& column : measureColumns()) {
    line += fmt::format("{:>{}}", textOf(column, measures), kColumnWidth);
  }
  return line + "\n";
}

std::string header() {
  std::string line(kNameWidth, ' ');
  for (const MeasureColumn& column : measureColumns()) {
    line += fmt::format("{:>{}}", column.name, kColumnWidth);
  }
  return line + "\n";
}

const char* wordOf(Verdict::State state, const char* passed, const char* failed) {
  switch (state) {
    case Verdict::State::kPassed:
      return passed;
    case Verdict::State::kFailed:
      return failed;
    case Verdict::State::kNotMeasured:
      break;
  }
  return "not measured";
}

std::string verdictLines(const std::vector<Verdict>& verdicts, const char* passed,
                         const char* failed) {
  std::string text;
  for (const Verdict& verdict : verdicts) {
    text += fmt::format("  {:<13} {}: {}\n", wordOf(verdict.state, passed, failed), verdict.what,
                        verdict.found);
  }
  return text;
}

std::string listLines(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text = "\n" + title + "\n";
  for (const std::string& line : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

bool Report::areControlsSound() const {
  return std::ranges::none_of(
      controls, [](const Verdict& each) { return each.state == Verdict::State::kFailed; });
}

bool Report::areGatesPassed() const {
  return std::ranges::all_of(
      gates, [](const Verdict& each) { return each.state == Verdict::State::kPassed; });
}

std::string nameOf(Subject subject, const Report& report) {
  switch (subject) {
    case Subject::kPainting:
      return report.style;
    case Subject::kInput:
      return "control: the input itself";
    case Subject::kFresh:
      return "control: redrawn each frame";
    case Subject::kFixed:
      return "control: fixed to the screen";
  }
  return "";
}

std::string reportText(const Report& report) {
  std::string text =
      fmt::format("{} ({}) on {}\n{}; {} frames measured after {}", report.style, report.settings,
                  report.input, report.motion, report.frames, report.settled);
  if (report.stillFrames > 0) {
    text += fmt::format("; xFLK on {} frames of a still, noise of {:g} levels", report.stillFrames,
                        report.stillNoise);
  }
  text += "\n\n" + header();
  for (const Subject subject : kAllSubjects) {
    text += row(nameOf(subject, report), report.measures[subject]);
  }
  text += "\nControls\n" + verdictLines(report.controls, "sound", "WRONG");
  if (!report.areControlsSound()) {
    text += "  THE CONTROLS DO NOT READ AS THEY MUST: nothing in this report can be relied on.\n";
  }
  if (!report.gates.empty()) {
    text +=
        fmt::format("\nGates of {}\n", report.style) + verdictLines(report.gates, "pass", "FAIL");
  }
  text += listLines("Left out", report.leftOut);
  text += listLines("Notes", report.notices);
  return text;
}

}  // namespace pleinair::measure
