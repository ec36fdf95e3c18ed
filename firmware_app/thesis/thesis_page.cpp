#include "firmware_app/thesis/thesis_page.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pipeline/measure/report/report_plots.h"

namespace pleinair::app {
namespace {

using measure::escaped;

constexpr const char* kStyleSheet = R"(
:root { color-scheme: light dark; --ink: #22262b; --soft: #5d656e; --line: #d8dce1;
  --paper: #fbfaf7; --card: #ffffff; --accent: #9c3c26; --bad: #b3261e; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e4df; --soft: #a0a4aa; --line: #3a3f46;
  --paper: #191b1e; --card: #212429; --accent: #ef8a6c; --bad: #f2857b; } }
body { margin: 0 auto; max-width: 64rem; padding: 2rem 1.25rem 4rem; background: var(--paper);
  color: var(--ink); font: 16px/1.55 system-ui, sans-serif; }
h1 { font-size: 1.7rem; line-height: 1.25; margin: 0 0 .4rem; }
h2 { font-size: 1.2rem; margin: 0 0 .5rem; }
p { margin: .4rem 0; } .soft { color: var(--soft); }
nav { display: flex; flex-wrap: wrap; gap: .3rem .9rem; margin: 1rem 0 2rem; }
nav a { color: var(--accent); text-decoration: none; } nav a:hover { text-decoration: underline; }
section { background: var(--card); border: 1px solid var(--line); border-radius: .6rem;
  padding: 1.2rem 1.3rem; margin: 0 0 1.6rem; }
b.who { color: var(--accent); font-weight: 600; }
figure { margin: 1rem 0; } figure img { display: block; max-width: 100%; height: auto;
  border-radius: .3rem; }
figcaption { color: var(--soft); font-size: .9rem; margin-top: .35rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; margin: .6rem 0; }
td { padding: .3rem 1.4rem .3rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td.value { text-align: right; white-space: nowrap; font-weight: 650; padding-right: 0; }
.alarm { border: 2px solid var(--bad); color: var(--bad); padding: .7rem 1rem; font-weight: 650;
  border-radius: .4rem; }
)";

std::string paragraph(const char* who, const std::string& text) {
  return fmt::format("<p><b class=\"who\">{}</b> {}</p>\n", who, escaped(text));
}

std::string sectionOf(const ThesisEntry& entry) {
  const ThesisFigure& figure = entry.figure;
  std::string html = fmt::format("<section id=\"f{}\">\n<h2>{}</h2>\n", entry.kind.name,
                                 escaped(entry.kind.title));
  html += paragraph("The thesis.", entry.kind.thesis) + paragraph("Here.", entry.kind.ours);
  for (std::size_t i = 0; i < figure.pictures.size(); ++i) {
    const ThesisPicture& picture = figure.pictures[i];
    html += fmt::format(
        "<figure><img src=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" loading=\"lazy\">"
        "<figcaption>{}</figcaption></figure>\n",
        entry.files.at(i), picture.image.cols, picture.image.rows, escaped(picture.caption),
        escaped(picture.caption));
  }
  html += "<div class=\"scroll\"><table>\n";
  for (const ThesisReading& reading : figure.readings) {
    html += fmt::format("<tr><td>{}</td><td class=\"value\">{}{}{}</td></tr>\n",
                        escaped(reading.text), readingText(reading.value),
                        reading.unit.empty() ? "" : " ", escaped(reading.unit));
  }
  html += "</table></div>\n" + paragraph("Measured.", figure.measured);
  return html + "</section>\n";
}

}  // namespace

std::string readingText(double value) {
  if (value == 0.0) return "0";
  const int digits = static_cast<int>(std::floor(std::log10(std::abs(value))));
  return fmt::format("{:.{}f}", value, std::clamp(2 - digits, 0, 5));
}

std::string thesisHtml(const ThesisReport& report) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>The thesis's figures, by "
      "pleinair</title><style>" +
      std::string(kStyleSheet) + "</style></head><body>\n";
  html +=
      "<h1>The thesis’s figures, made by pleinair</h1>\n<p>Figures 15 to 42, table 1 and §6.1 "
      "of <i>Non-photorealistic rendering with coherence for augmented reality</i>: what each "
      "of them shows, in our words, what this program shows in its place, and a number. The "
      "thesis’s own films and models are not published; here all are built in.</p>\n";
  html += fmt::format("<p class=\"soft\">{}</p>\n", escaped(report.settings));
  for (const std::string& control : report.failedControls) {
    html += fmt::format(
        "<p class=\"alarm\">A control does not read as it must, so measured figures of films "
        "cannot be relied on: {}</p>\n",
        escaped(control));
  }
  html += "<nav>";
  for (const ThesisEntry& entry : report.entries) {
    const std::string& title = entry.kind.title;
    html += fmt::format("<a href=\"#f{}\">{}</a>", entry.kind.name,
                        escaped(title.substr(0, title.find(':'))));
  }
  html += "</nav>\n";
  for (const ThesisEntry& entry : report.entries) html += sectionOf(entry);
  return html + "</body></html>\n";
}

std::string thesisJson(const ThesisReport& report) {
  nlohmann::ordered_json json;
  json["settings"] = report.settings;
  json["failed_controls"] = report.failedControls;
  json["figures"] = nlohmann::ordered_json::array();
  for (const ThesisEntry& entry : report.entries) {
    nlohmann::ordered_json figure;
    figure["name"] = entry.kind.name;
    figure["title"] = entry.kind.title;
    figure["numbers"] = entry.kind.numbers;
    figure["pictures"] = entry.files;
    figure["seconds"] = entry.seconds;
    nlohmann::ordered_json readings = nlohmann::ordered_json::object();
    for (const ThesisReading& reading : entry.figure.readings) {
      readings[reading.key] = reading.value;
    }
    figure["readings"] = std::move(readings);
    json["figures"].push_back(std::move(figure));
  }
  return json.dump(2) + "\n";
}

}  // namespace pleinair::app
