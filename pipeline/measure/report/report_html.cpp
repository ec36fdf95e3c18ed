#include <span>

#include <fmt/format.h>

#include "hal/media/png_file.h"
#include "pipeline/measure/measurement_report.h"
#include "pipeline/measure/report/report_plots.h"

namespace pleinair::measure {
namespace {

constexpr const char* kStyleSheet = R"(
:root { color-scheme: light dark; --ink: #22262b; --soft: #68707a; --line: #d8dce1;
  --paper: #fbfaf7; --card: #ffffff; --painting: #b5452c; --input: #3d6f99; --second: #b08a2e;
  --good: #2d7a46; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e4df; --soft: #a0a4aa; --line: #3a3f46;
  --paper: #191b1e; --card: #212429; --painting: #ef8a6c; --input: #82b4de; --second: #d9b765;
  --good: #79c891; --bad: #f2857b; } }
body { margin: 0 auto; max-width: 76rem; padding: 2rem 1.25rem 4rem; background: var(--paper);
  color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.7rem; margin: 0; } h2 { font-size: 1.15rem; margin: 2.4rem 0 .7rem; }
p { margin: .3rem 0; } .soft { color: var(--soft); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .8rem; text-align: right; border-bottom: 1px solid var(--line); }
th { font-weight: 600; } th:first-child, td:first-child, .words td { text-align: left; }
tr.own td { font-weight: 650; color: var(--painting); }
.pass { color: var(--good); font-weight: 650; } .fail { color: var(--bad); font-weight: 650; }
.alarm { border: 2px solid var(--bad); color: var(--bad); padding: .7rem 1rem; font-weight: 650;
  border-radius: .4rem; }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(22rem, 1fr)); gap: 1rem; }
.plots svg { background: var(--card); border: 1px solid var(--line); border-radius: .4rem;
  width: 100%; }
.grid { stroke: var(--line); } .tick, .label { fill: var(--soft); font-size: 10px; }
.title { fill: var(--ink); font-size: 12px; font-weight: 600; }
.line { fill: none; stroke-width: 1.6; } .line.painting { stroke: var(--painting); }
.line.input { stroke: var(--input); } .line.second { stroke: var(--second); }
.key span { margin-right: 1.2rem; } .key b { font-weight: 700; }
figure { margin: 0 0 1.4rem; } figcaption { margin-bottom: .4rem; }
.frames { display: grid; grid-template-columns: repeat(3, 1fr); gap: .5rem; }
.frames img { width: 100%; border: 1px solid var(--line); border-radius: .25rem; }
@media (max-width: 45rem) { .frames { grid-template-columns: 1fr; } }
)";

std::string base64(std::span<const std::uint8_t> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8U | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

std::string pictureHtml(const hal::Image& picture, const std::string& what) {
  const auto png = hal::encodePng(picture.view());
  if (!png) return fmt::format("<p>{}: {}</p>", what, escaped(png.error().message()));
  return fmt::format(R"(<img alt="{}" title="{}" src="data:image/png;base64,{}">)", what, what,
                     base64(*png));
}

std::string measuresTable(const Report& report) {
  std::string html = "<div class=\"scroll\"><table><tr><th></th>";
  for (const MeasureColumn& column : measureColumns()) {
    html += fmt::format("<th title=\"{}\">{}</th>", escaped(column.reads), column.name);
  }
  html += "</tr>\n";
  for (const Subject subject : kAllSubjects) {
    html += fmt::format("<tr{}><td>{}</td>", subject == Subject::kPainting ? " class=\"own\"" : "",
                        escaped(nameOf(subject, report)));
    for (const MeasureColumn& column : measureColumns()) {
      html += fmt::format("<td>{}</td>", textOf(column, report.measures[subject]));
    }
    html += "</tr>\n";
  }
  html += "</table></div>\n<details><summary class=\"soft\">What they read</summary><ul>";
  for (const MeasureColumn& column : measureColumns()) {
    html += fmt::format("<li><b>{}</b>: {}</li>", column.name, escaped(column.reads));
  }
  return html + "</ul></details>\n";
}

std::string verdictTable(const std::vector<Verdict>& verdicts, const char* passed,
                         const char* failed) {
  std::string html = "<div class=\"scroll\"><table class=\"words\">";
  for (const Verdict& verdict : verdicts) {
    const bool isPass = verdict.state == Verdict::State::kPassed;
    const bool isFail = verdict.state == Verdict::State::kFailed;
    html += fmt::format("<tr><td class=\"{}\">{}</td><td>{}</td><td>{}</td></tr>\n",
                        isPass   ? "pass"
                        : isFail ? "fail"
                                 : "soft",
                        isPass   ? passed
                        : isFail ? failed
                                 : "not measured",
                        escaped(verdict.what), escaped(verdict.found));
  }
  return html + "</table></div>\n";
}

std::string listHtml(const std::string& title, const std::vector<std::string>& lines) {
  if (lines.empty()) return "";
  std::string html = "<h2>" + title + "</h2><ul>";
  for (const std::string& line : lines) html += "<li>" + escaped(line) + "</li>";
  return html + "</ul>\n";
}

std::string modelsTable(const Report& report) {
  if (!report.models) return "";
  const auto cell = [](std::optional<double> value) {
    return value ? fmt::format("<td>{:.3g}</td>", *value) : std::string("<td>–</td>");
  };
  std::string html =
      "<h2>Models</h2><div class=\"scroll\"><table><tr><th></th><th>EW2</th><th>nHW2</th>"
      "<th>POP %</th><th>S10 %</th></tr>\n";
  for (const Region region : kAllRegions) {
    const PerSubject<RegionSummary>& of = report.models->regions[region];
    html += fmt::format("<tr><th colspan=\"5\">{}: {:.1f} % of the frames</th></tr>\n",
                        escaped(descriptionOf(region)), of[Subject::kPainting].coveredPercent);
    for (const Subject subject : kAllSubjects) {
      const RegionSummary& values = of[subject];
      html +=
          fmt::format("<tr{}><td>{}</td>", subject == Subject::kPainting ? " class=\"own\"" : "",
                      escaped(nameOf(subject, report)));
      html += cell(values.ew2) + cell(values.nHw2) + cell(values.popPercent) +
              cell(values.s10Percent) + "</tr>\n";
    }
  }
  html += "</table></div>\n";
  for (const std::string& line : anchorsOnModelsLines(report)) {
    html += "<p>" + escaped(line) + "</p>";
  }
  return html;
}

std::string plotsHtml(const Report& report) {
  std::vector<std::uint64_t> frames;
  for (const FrameValues& values : report.overTime) frames.push_back(values.frame);
  std::string plots;
  for (const MeasureColumn& column : measureColumns()) {
    PlotLine painting{report.style, "painting", {}};
    PlotLine input{"the input", "input", {}};
    for (const FrameValues& values : report.overTime) {
      painting.values.push_back(values.painting.*column.value);
      input.values.push_back(values.input.*column.value);
    }
    plots += plotSvg({column.name, column.unit}, frames, {input, painting});
  }
  PlotLine births{"births", "second", {}};
  PlotLine deaths{"deaths", "painting", {}};
  PlotLine drift{"drift", "painting", {}};
  for (const FrameValues& values : report.overTime) {
    const std::optional<AnchorFrame>& anchors = values.anchors;
    const auto valueOf = [&anchors](auto read) {
      return anchors ? std::optional<double>(read(*anchors)) : std::nullopt;
    };
    births.values.push_back(
        valueOf([](const AnchorFrame& each) { return static_cast<double>(each.innerBirths); }));
    deaths.values.push_back(
        valueOf([](const AnchorFrame& each) { return static_cast<double>(each.innerDeaths); }));
    drift.values.push_back(anchors && anchors->drift ? std::optional(anchors->drift->median)
                                                     : std::nullopt);
  }
  plots += plotSvg({"births and deaths away from the border", "marks a frame"}, frames,
                   {births, deaths});
  plots += plotSvg({"anchor drift a frame, median", "px"}, frames, {drift});
  if (plots.empty()) return "";
  return "<h2>Over time</h2><p class=\"key soft\"><span><b style=\"color:var(--painting)\">—</b> " +
         escaped(report.style) +
         " (deaths)</span><span><b style=\"color:var(--input)\">—</b> the input</span><span>"
         "<b style=\"color:var(--second)\">—</b> births</span></p><div class=\"plots\">" +
         plots + "</div>\n";
}

std::string worstHtml(const Report& report) {
  if (report.worst.empty()) return "";
  std::string html =
      "<h2>The worst frames</h2><p class=\"soft\">The input, the painting, and its difference "
      "along the motion to two frames before, so many times as strong as it is.</p>";
  for (const WorstFrame& worst : report.worst) {
    html += fmt::format(
        "<figure><figcaption>Frame {}, EW2 {:.3f}; the difference × {:g}</figcaption><div "
        "class=\"frames\">{}{}{}</div>"
        "</figure>\n",
        worst.frame, worst.ew2, worst.differenceGain, pictureHtml(worst.input, "the input"),
        pictureHtml(worst.output, "the painting"),
        pictureHtml(worst.difference, "the difference along the motion"));
  }
  return html;
}

}  // namespace

std::string reportHtml(const Report& report) {
  const std::string title = escaped(report.style + " on " + report.input);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>" +
      title + "</title><style>" + kStyleSheet + "</style></head><body>\n";
  html += fmt::format("<h1>{}</h1><p class=\"soft\">{}</p><p class=\"soft\">{}</p>\n", title,
                      escaped(report.settings + "; " + report.motion), escaped(framesText(report)));
  if (!report.areControlsValid()) {
    html +=
        "<p class=\"alarm\">The controls do not read as they must: nothing in this report can "
        "be relied on.</p>\n";
  }
  html += "<h2>Measures</h2>\n" + measuresTable(report);
  html += "<h2>Controls</h2>\n" + verdictTable(report.controls, "valid", "WRONG");
  if (!report.gates.empty()) {
    html += "<h2>Gates of " + escaped(report.style) + "</h2>\n" +
            verdictTable(report.gates, "pass", "FAIL");
  }
  html += listHtml("Inside", insideLines(report));
  html += listHtml("Movers", moverLines(report));
  html += listHtml("Labels of movers", labelLines(report));
  html += modelsTable(report);
  html += listHtml("Flatness", flatnessLines(report));
  html += plotsHtml(report) + worstHtml(report);
  html += listHtml("Left out", report.leftOut) + listHtml("Notes", report.notices);
  return html + "</body></html>\n";
}

}  // namespace pleinair::measure
