#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "hal/clock.h"
#include "hal/error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::record {

using WallTime = std::chrono::sys_time<std::chrono::milliseconds>;

/// A moment by both clocks: the wall clock may be wrong or set back; the monotonic one counts from
/// the start of the machine and goes on while it sleeps.
struct Moment {
  WallTime wall;
  std::chrono::milliseconds monotonic{0};
  bool isClockTrusted = false;  ///< the kernel takes the wall clock for synchronised
  std::string boot;             ///< tells starts of the machine apart
};
using MomentSource = std::function<Moment()>;

/// The machine's clocks (CLOCK_REALTIME, CLOCK_BOOTTIME, adjtimex). Any thread.
Moment systemMoment();

/// How well the machine was located when a step was done.
struct PoseQuality {
  std::string source;                      ///< "seen", "carried", "none"
  std::optional<double> rmsPx;             ///< reprojection error, where it is known
  std::optional<double> sigmaMillimetres;  ///< predicted, of the place, over all axes
};

// What may happen. Steps are named by their ids; "end" is the end.

struct Begun {
  std::string procedure;
  std::string version;
  std::string hash;     ///< Procedure::hash
  std::string program;  ///< version of this program
  std::string operatorName;
  std::string workOrder;  ///< may be empty
  std::string language;
  std::string step;  ///< the first
};
struct StepDone {
  std::string step;
  procedure::Outcome outcome = procedure::Outcome::kDone;
  std::optional<double> value;  ///< of a check
  std::string unit;
  std::chrono::milliseconds took{0};
  std::optional<PoseQuality> pose;
  std::string by;    ///< who compared a still with its template: "program", "operator"; else empty
  std::string next;  ///< the same step where the outcome keeps it
};
struct SteppedBack {
  std::string from;
  std::string next;
};
struct StillTaken {
  std::string step;
  std::string when;  ///< "before", "after", "check"
  std::string file;  ///< relative to the record's folder
  std::string sha256;
  std::uint64_t bytes = 0;
};
struct OperatorChanged {
  std::string operatorName;
};
/// The procedure was edited while it ran.
struct ProcedureChanged {
  std::string version;
  std::string hash;
};
/// The program began again after it ended without signing off.
struct Resumed {
  std::uint64_t cutBytes = 0;  ///< of a line that a power cut had torn
  std::string program;
};
enum class SignOff { kCompleted, kAborted };
struct SignedOff {
  SignOff result = SignOff::kCompleted;
  std::string operatorName;
  std::string remark;
};

using Event = std::variant<Begun, StepDone, SteppedBack, StillTaken, OperatorChanged,
                           ProcedureChanged, Resumed, SignedOff>;

/// One line of a record.
struct RecordEntry {
  std::uint64_t number = 0;  ///< from 0
  std::string previous;      ///< hash of the line before; 64 zeros for the first
  Moment moment;
  Event event;
  std::string hash;
};

inline constexpr std::size_t kMaxLineBytes = std::size_t{1} << 16U;

/// 64 zeros.
const std::string& noHash();

/// The line with its hash and newline, and sets `entry.hash`: a JSON object whose last key, "hash",
/// is the SHA-256 of all bytes before `,"hash":`. A sign-off also has "final", the hash of the line
/// before, and "entries", the number of lines. Invalid UTF-8 is replaced.
std::string lineOf(RecordEntry& entry);

/// Reads a line without its newline, and verifies its hash. The error's problem says what is wrong.
hal::Result<RecordEntry> entryOf(std::string_view line);

/// "2026-11-24T03:21:44.123Z"
std::string wallText(WallTime wall);

}  // namespace pleinair::record
