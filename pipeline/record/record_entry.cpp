#include "pipeline/record/record_entry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hal/overloaded.h"
#include "pipeline/digest/sha256.h"

namespace pleinair::record {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kHashKey = ",\"hash\":\"";
constexpr std::string_view kLineEnd = "\"}";
constexpr std::size_t kHashDigits = 64;

std::string_view nameOf(SignOff result) {
  return result == SignOff::kCompleted ? "completed" : "aborted";
}

void addPose(Json& line, const std::optional<PoseQuality>& pose) {
  if (!pose) return;
  Json& json = line["pose"] = {{"source", pose->source}};
  if (pose->rmsPx) json["rms_px"] = *pose->rmsPx;
  if (pose->sigmaMillimetres) json["sigma_mm"] = *pose->sigmaMillimetres;
}

void addEvent(Json& line, const Event& event, const RecordEntry& entry) {
  std::visit(hal::Overloaded{[&](const Begun& each) {
                               line["type"] = "begin";
                               line["format"] = 1;
                               line["procedure"] = each.procedure;
                               line["version"] = each.version;
                               line["procedure_sha256"] = each.hash;
                               line["program"] = each.program;
                               line["operator"] = each.operatorName;
                               line["work_order"] = each.workOrder;
                               line["language"] = each.language;
                               line["step"] = each.step;
                             },
                             [&](const StepDone& each) {
                               line["type"] = "step";
                               line["step"] = each.step;
                               line["outcome"] = procedure::nameOf(each.outcome);
                               if (each.value) line["value"] = *each.value;
                               if (each.value) line["unit"] = each.unit;
                               line["took_ms"] = each.took.count();
                               addPose(line, each.pose);
                               if (!each.by.empty()) line["by"] = each.by;
                               line["next"] = each.next;
                             },
                             [&](const SteppedBack& each) {
                               line["type"] = "back";
                               line["from"] = each.from;
                               line["next"] = each.next;
                             },
                             [&](const StillTaken& each) {
                               line["type"] = "still";
                               line["step"] = each.step;
                               line["when"] = each.when;
                               line["file"] = each.file;
                               line["sha256"] = each.sha256;
                               line["bytes"] = each.bytes;
                             },
                             [&](const OperatorChanged& each) {
                               line["type"] = "operator";
                               line["operator"] = each.operatorName;
                             },
                             [&](const ProcedureChanged& each) {
                               line["type"] = "procedure";
                               line["version"] = each.version;
                               line["procedure_sha256"] = each.hash;
                             },
                             [&](const Resumed& each) {
                               line["type"] = "resumed";
                               line["cut_bytes"] = each.cutBytes;
                               line["program"] = each.program;
                             },
                             [&](const SignedOff& each) {
                               line["type"] = "signed_off";
                               line["result"] = nameOf(each.result);
                               line["operator"] = each.operatorName;
                               line["remark"] = each.remark;
                               line["entries"] = entry.number + 1;
                               line["final"] = entry.previous;
                             }},
             event);
}

std::optional<PoseQuality> poseOf(const Json& line) {
  if (!line.contains("pose")) return std::nullopt;
  const Json& pose = line.at("pose");
  const auto number = [&](const char* key) {
    return pose.contains(key) ? std::optional(pose.at(key).get<double>()) : std::nullopt;
  };
  return PoseQuality{.source = pose.at("source").get<std::string>(),
                     .rmsPx = number("rms_px"),
                     .sigmaMillimetres = number("sigma_mm")};
}

StepDone stepOf(const Json& line) {
  const auto outcome = procedure::outcomeNamed(line.at("outcome").get<std::string>());
  if (!outcome) throw std::invalid_argument("an unknown outcome");
  StepDone done{.step = line.at("step").get<std::string>(),
                .outcome = *outcome,
                .took = std::chrono::milliseconds(line.at("took_ms").get<std::int64_t>()),
                .pose = poseOf(line),
                .by = line.contains("by") ? line.at("by").get<std::string>() : std::string(),
                .next = line.at("next").get<std::string>()};
  if (line.contains("value")) {
    done.value = line.at("value").get<double>();
    done.unit = line.at("unit").get<std::string>();
  }
  return done;
}

Event eventOf(const Json& line) {
  const auto type = line.at("type").get<std::string>();
  const auto text = [&](const char* key) { return line.at(key).get<std::string>(); };
  if (type == "begin") {
    if (line.at("format").get<int>() != 1) throw std::invalid_argument("another format than 1");
    return Begun{.procedure = text("procedure"),
                 .version = text("version"),
                 .hash = text("procedure_sha256"),
                 .program = text("program"),
                 .operatorName = text("operator"),
                 .workOrder = text("work_order"),
                 .language = text("language"),
                 .step = text("step")};
  }
  if (type == "step") return stepOf(line);
  if (type == "back") return SteppedBack{.from = text("from"), .next = text("next")};
  if (type == "still") {
    return StillTaken{.step = text("step"),
                      .when = text("when"),
                      .file = text("file"),
                      .sha256 = text("sha256"),
                      .bytes = line.at("bytes").get<std::uint64_t>()};
  }
  if (type == "operator") return OperatorChanged{.operatorName = text("operator")};
  if (type == "procedure") {
    return ProcedureChanged{.version = text("version"), .hash = text("procedure_sha256")};
  }
  if (type == "resumed") {
    return Resumed{.cutBytes = line.at("cut_bytes").get<std::uint64_t>(),
                   .program = text("program")};
  }
  if (type == "signed_off") {
    const std::string result = text("result");
    if (result != "completed" && result != "aborted") throw std::invalid_argument("no result");
    if (line.at("entries").get<std::uint64_t>() != line.at("n").get<std::uint64_t>() + 1 ||
        text("final") != text("prev")) {
      throw std::invalid_argument("a sign-off of other lines");
    }
    return SignedOff{.result = result == "completed" ? SignOff::kCompleted : SignOff::kAborted,
                     .operatorName = text("operator"),
                     .remark = text("remark")};
  }
  throw std::invalid_argument("an unknown type");
}

std::optional<WallTime> wallOf(const std::string& text) {
  int year = 0;
  unsigned month = 0;
  unsigned day = 0;
  int hours = 0;
  int minutes = 0;
  int seconds = 0;
  int milliseconds = 0;
  if (std::sscanf(text.c_str(), "%4d-%2u-%2uT%2d:%2d:%2d.%3dZ", &year, &month, &day, &hours,
                  &minutes, &seconds, &milliseconds) != 7) {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(day)};
  if (!date.ok()) return std::nullopt;
  return WallTime(std::chrono::sys_days(date)) + std::chrono::hours(hours) +
         std::chrono::minutes(minutes) + std::chrono::seconds(seconds) +
         std::chrono::milliseconds(milliseconds);
}

hal::Error fault(std::string problem) {
  return {.kind = hal::ErrorKind::kInvalidInput, .problem = std::move(problem)};
}

}  // namespace

const std::string& noHash() {
  static const std::string kNone(kHashDigits, '0');
  return kNone;
}

std::string wallText(WallTime wall) {
  const auto day = std::chrono::floor<std::chrono::days>(wall);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(wall - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     time.hours().count(), time.minutes().count(), time.seconds().count(),
                     time.subseconds().count());
}

std::string lineOf(RecordEntry& entry) {
  Json line;
  line["n"] = entry.number;
  line["prev"] = entry.previous;
  line["wall"] = wallText(entry.moment.wall);
  line["clock"] = entry.moment.isClockTrusted ? "trusted" : "untrusted";
  line["monotonic_ms"] = entry.moment.monotonic.count();
  line["boot"] = entry.moment.boot;
  addEvent(line, entry.event, entry);
  std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.pop_back();  // the closing brace
  entry.hash = digest::hexOf(digest::sha256(text));
  return fmt::format("{}{}{}{}\n", text, kHashKey, entry.hash, kLineEnd);
}

hal::Result<RecordEntry> entryOf(std::string_view line) {
  const std::size_t tail = kHashKey.size() + kHashDigits + kLineEnd.size();
  if (line.size() <= tail || line.size() > kMaxLineBytes) {
    return tl::unexpected(fault("is no line of a record"));
  }
  const std::string_view body = line.substr(0, line.size() - tail);
  const std::string_view hash = line.substr(body.size() + kHashKey.size(), kHashDigits);
  if (line.substr(body.size(), kHashKey.size()) != kHashKey || !line.ends_with(kLineEnd)) {
    return tl::unexpected(fault("does not end with a hash"));
  }
  if (digest::hexOf(digest::sha256(body)) != hash) {
    return tl::unexpected(fault("was changed: its hash is not that of its content"));
  }
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return tl::unexpected(fault("is no JSON object"));
  try {
    RecordEntry entry{.number = json.at("n").get<std::uint64_t>(),
                      .previous = json.at("prev").get<std::string>()};
    const auto wall = wallOf(json.at("wall").get<std::string>());
    if (!wall) return tl::unexpected(fault("has no valid time"));
    entry.moment = {
        .wall = *wall,
        .monotonic = std::chrono::milliseconds(json.at("monotonic_ms").get<std::int64_t>()),
        .isClockTrusted = json.at("clock").get<std::string>() == "trusted",
        .boot = json.at("boot").get<std::string>()};
    entry.event = eventOf(json);
    entry.hash = hash;
    return entry;
  } catch (const std::exception& error) {
    return tl::unexpected(fault(fmt::format("cannot be read: {}", error.what())));
  }
}

}  // namespace pleinair::record
