#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "pipeline/measure/measurement_report.h"

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

std::string halfLifeText(const AnchorSummary& anchors) {
  if (anchors.halfLifeFrames) {
    return fmt::format("half of the marks live longer than {:.0f} frames", *anchors.halfLifeFrames);
  }
  return fmt::format("half-life of the marks: over {} frames, {}", anchors.frames,
                     anchors.innerDeaths > 0 ? "for fewer than half died in these"
                                             : "in which none died away from the border");
}

std::string driftText(const Drift& drift) {
  return fmt::format("median {:.3f} px, 95 % below {:.3f} px, rms {:.3f} px", drift.median,
                     drift.percentile95, drift.rms);
}

std::string listLines(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string text = "\n" + title + "\n";
  for (const std::string& line : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace

bool Report::areControlsValid() const {
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

std::string framesText(const Report& report) {
  std::string text = fmt::format("{} frames measured after {}", report.frames, report.settled);
  if (report.stillFrames > 0) {
    text += fmt::format("; xFLK on {} frames of a still, noise of {:g} levels", report.stillFrames,
                        report.stillNoise);
  }
  return text;
}

std::vector<std::string> insideLines(const Report& report) {
  std::vector<std::string> lines;
  if (report.inside) {
    const AnchorSummary& anchors = *report.inside;
    lines.push_back(fmt::format(
        "{:.0f} anchors; a frame {:.1f} births and {:.1f} deaths, of which {:.1f} and {:.1f} away "
        "from the border: {:.2f} % of the marks there",
        anchors.alive, anchors.births, anchors.deaths, anchors.innerBirths, anchors.innerDeaths,
        anchors.innerTurnoverPercent));
    lines.push_back(halfLifeText(anchors));
    if (anchors.drift) lines.push_back("drift a frame: " + driftText(*anchors.drift));
    if (anchors.longDrift)
      lines.push_back("drift over ten frames: " + driftText(*anchors.longDrift));
    lines.push_back(
        fmt::format("anchors per 8x8 cell: {:.2f}, spread {:.2f}, {:.1f} % of the cells empty",
                    anchors.perCell, anchors.spreadPerCell, anchors.emptyCellsPercent));
  }
  if (report.insideStill) {
    const AnchorSummary& anchors = *report.insideStill;
    const auto frames = static_cast<double>(anchors.frames);
    lines.push_back(fmt::format(
        "on the still scene: {:.0f} births, {:.0f} deaths, {:.0f} moves in {} frames",
        anchors.births * frames, anchors.deaths * frames, anchors.moved * frames, anchors.frames));
  }
  return lines;
}

std::vector<std::string> flatnessLines(const Report& report) {
  if (!report.flatness) return {};
  const auto line = [](const char* of, const TextureDifference& difference) {
    return fmt::format("{}: co-occurrence error {:.3f}, spectrum {:.3f}, mean frequency × {:.2f}",
                       of, difference.cooccurrenceError, difference.spectrumError,
                       difference.frequencyRatio);
  };
  const Flatness& flatness = *report.flatness;
  return {fmt::format("the picture grows {:.2f} times; marks of the same size on the screen keep "
                      "their frequency, marks that grow with it read × {:.2f}",
                      flatness.scale, 1.0 / flatness.scale),
          line("the painting", flatness.painting), line("the input", flatness.input)};
}

std::vector<std::string> moverLines(const Report& report) {
  if (!report.movers) return {};
  const auto text = [](std::optional<double> value, const char* unit) {
    return value ? fmt::format("{:.3g}{}", *value, unit) : std::string("not seen");
  };
  const auto line = [&](const char* of, const MoverSummary& movers) {
    return fmt::format("{}: STILL {}, RETURN {}, GHOST {}, FOLLOW {}, REMAINS {}, LOST {}", of,
                       text(movers.stillPercent, " %"), text(movers.returnLevels, ""),
                       text(movers.ghost, ""), text(movers.follow, ""),
                       text(movers.remainsPercent, " %"), text(movers.lostPercent, " %"));
  };
  const MoverReport& movers = *report.movers;
  std::vector<std::string> lines{
      fmt::format("{} cover {:.2f} % of the frames",
                  movers.areMasksTrue ? "the true masks of movers"
                                      : "movers, found by their difference from the median,",
                  movers.painting.coveredPercent),
      line("the painting", movers.painting),
      line("a painter that averages over 0.65 s", movers.averaging)};
  for (const Subject subject : kAllSubjects) {
    const MoverMotionSummary& along = movers.alongMotion[subject];
    lines.push_back(
        fmt::format("{}, along the {} motion: MOVER nHW2 {}, MOVER POP {}, SEAM POP {}; "
                    "smoothed {}, {}",
                    subject == Subject::kPainting ? "the painting" : nameOf(subject, report),
                    movers.areMasksTrue ? "true" : "estimated", text(along.nHw2, ""),
                    text(along.popPercent, " %"), text(along.seamPopPercent, " %"),
                    text(along.smoothPopPercent, " %"), text(along.smoothSeamPopPercent, " %")));
  }
  return lines;
}

std::vector<std::string> labelLines(const Report& report) {
  std::vector<std::string> lines;
  if (report.labels) {
    const LabelSummary& labels = *report.labels;
    if (labels.meanIou) {
      lines.push_back(fmt::format("IoU with the true masks: mean {:.3f}, worst {:.3f} in frame {}",
                                  *labels.meanIou, *labels.worstIou, labels.worstFrame));
    }
    for (const Detection& each : labels.detections) {
      lines.push_back(fmt::format("the mover that came in frame {} {} after {} frames, {:.0f} ms",
                                  each.frame, each.isFound ? "was labelled" : "had gone unlabelled",
                                  each.frames, 1000 * hal::toSeconds(each.time)));
    }
    if (labels.flipsPercent) {
      lines.push_back(
          fmt::format("labels that flip away from movers: {:.3g} % a frame", *labels.flipsPercent));
    }
  }
  if (report.labelFlipsOnStillPercent) {
    lines.push_back(fmt::format("labels that flip on the still scene: {:.3g} % a frame",
                                *report.labelFlipsOnStillPercent));
  }
  return lines;
}

std::vector<std::string> anchorsOnModelsLines(const Report& report) {
  std::vector<std::string> lines;
  if (!report.models || !report.models->anchors) return lines;
  const ModelAnchorSummary& anchors = *report.models->anchors;
  lines.push_back(fmt::format(
      "{:.0f} anchors on what stays in sight of models; a frame {:.2f} births and {:.2f} deaths "
      "there: {:.2f} % of them, where the area on the screen changes by {:.2f} %",
      anchors.anchors, anchors.births, anchors.deaths, anchors.turnoverPercent,
      anchors.resizedPercent));
  if (anchors.slip) lines.push_back("slip a frame: " + driftText(*anchors.slip));
  if (anchors.longSlip) lines.push_back("slip over ten frames: " + driftText(*anchors.longSlip));
  return lines;
}

std::vector<std::string> modelLines(const Report& report) {
  if (!report.models) return {};
  const auto text = [](std::optional<double> value, const char* unit) {
    return value ? fmt::format("{:.3g}{}", *value, unit) : std::string("–");
  };
  std::vector<std::string> lines;
  for (const Region region : kAllRegions) {
    const PerSubject<RegionSummary>& of = report.models->regions[region];
    lines.push_back(fmt::format("{}: {:.1f} % of the frames", descriptionOf(region),
                                of[Subject::kPainting].coveredPercent));
    for (const Subject subject : kAllSubjects) {
      const RegionSummary& values = of[subject];
      lines.push_back(fmt::format("  {}: EW2 {}, nHW2 {}, POP {}, S10 {}", nameOf(subject, report),
                                  text(values.ew2, ""), text(values.nHw2, ""),
                                  text(values.popPercent, " %"), text(values.s10Percent, " %")));
    }
  }
  for (std::string& line : anchorsOnModelsLines(report)) lines.push_back(std::move(line));
  return lines;
}

std::string descriptionOf(Region region) {
  switch (region) {
    case Region::kReal:
      return "REAL, the camera's picture beyond the seam";
    case Region::kVirtual:
      return "VIRTUAL, models";
    case Region::kSeam:
      return "SEAM, 8 px on both sides of their outlines";
    case Region::kMoving:
      return "models where they move by 2 px in two frames";
  }
  return "";
}

std::string reportText(const Report& report) {
  std::string text = fmt::format("{} ({}) on {}\n{}; {}\n\n", report.style, report.settings,
                                 report.input, report.motion, framesText(report));
  text += header();
  for (const Subject subject : kAllSubjects) {
    text += row(nameOf(subject, report), report.measures[subject]);
  }
  text += "\nControls\n" + verdictLines(report.controls, "valid", "WRONG");
  if (!report.areControlsValid()) {
    text += "  THE CONTROLS DO NOT READ AS THEY MUST: nothing in this report can be relied on.\n";
  }
  if (!report.gates.empty()) {
    text +=
        fmt::format("\nGates of {}\n", report.style) + verdictLines(report.gates, "pass", "FAIL");
  }
  text += listLines("Inside", insideLines(report));
  text += listLines("Flatness", flatnessLines(report));
  text += listLines("Movers", moverLines(report));
  text += listLines("Labels of movers", labelLines(report));
  text += listLines("Models", modelLines(report));
  text += listLines("Left out", report.leftOut);
  text += listLines("Notes", report.notices);
  return text;
}

}  // namespace pleinair::measure
