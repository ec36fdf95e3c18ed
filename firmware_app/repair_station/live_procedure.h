#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>

#include "firmware_app/overlay/step_content.h"
#include "firmware_app/repair_station/pending_stills.h"
#include "firmware_app/repair_station/step_worker.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "hal/key_pressed.h"
#include "pipeline/inspection/part_inspection.h"
#include "pipeline/inspection/template_file.h"
#include "pipeline/procedure/notices.h"
#include "pipeline/procedure/step_command.h"
#include "pipeline/procedure/stepper.h"
#include "pipeline/runtime/status/procedure_status.h"

namespace pleinair::app {

struct LiveProcedureOptions {
  std::filesystem::path folder;
  std::string language;           ///< empty: the procedure's first
  std::filesystem::path records;  ///< the folder of records; empty: nothing is recorded
  std::string operatorName;       ///< empty: unnamed, or whoever the resumed record names
  std::string workOrder;
  std::string program;         ///< version of this program
  bool stillsOfSteps = false;  ///< a still before and after each step, beside those of checks
  record::RecordSystem system = record::RecordSystem::real();
};

/// A procedure that is carried out while painting goes on: keys in, steps and a record out. Main
/// thread, unless said otherwise.
///
/// Page Down, which pedals and presenters send, ends a step; Page Up goes back; y and n answer;
/// digits and Enter give a value; Enter signs off at the end, Shift-X twice before it. Page Down
/// answers no question: a check is not passed by going on.
///
/// A StepWorker writes the record. A step is left once its line is on the disk, which poll() sees;
/// until then further answers are refused with a notice. So is an answer that the thread finds a
/// newer version of the procedure for: nobody has seen that version's text and limits.
///
/// Of two inputs at once one counts: after an answer or a step back, other inputs are ignored for
/// kOneAtATime, for whoever used them has not seen the new step.
class LiveProcedure {
 public:
  static constexpr hal::Duration kOneAtATime = std::chrono::milliseconds(400);
  /// Within this of the first press, a second one signs off before the end.
  static constexpr hal::Duration kAbortAgain = std::chrono::seconds(5);
  /// A contact that bounces presses twice.
  static constexpr hal::Duration kBounce = std::chrono::milliseconds(50);
  /// How long a pose says where the machine is, where no frame comes.
  static constexpr hal::Duration kPoseLasts = std::chrono::milliseconds(500);

  /// Loads the procedure, and goes on with its newest record that is not signed off, or begins one.
  /// `clock` outlives this. Throws hal::Failure and config::ConfigError.
  LiveProcedure(LiveProcedureOptions options, const hal::Clock& clock);

  /// Handles a key; false if it has no meaning here.
  bool press(const hal::KeyPressed& key);
  /// Obeys a command of another input, which `source` names; false if it has no meaning here, which
  /// a notice says. Precondition: not StepCommandKind::kRaw, which concerns the painting.
  bool obey(const procedure::StepCommand& command, const std::string& source);
  /// How well the machine is located in a frame that has just come, for the record; nothing: the
  /// scene does not place it. After kPoseLasts without a call, the record says "none".
  void locate(const std::optional<record::PoseQuality>& pose);
  /// The current step for the caption: number, title, text, what it asks for.
  std::string text() const;
  /// What the current step shows.
  StepShown shown() const;
  /// The next event for the caption and the log, in order: a check that failed, an input that did
  /// not count. In the procedure's language, but for errors of the system.
  std::optional<std::string> takeNotice();
  /// The next failure, likewise: a step that a full disk kept from being done, a mistake in an
  /// edited procedure.
  std::optional<std::string> takeFailure();
  /// The language in force.
  const std::string& language() const { return options_.language; }

  /// The version in force.
  const procedure::Procedure& procedure() const { return stepper().procedure(); }

  /// Whether a still of the camera is wanted, asked once for each.
  bool takeStillRequest();
  /// Takes the still that was wanted: it is saved, and ends the step that waited for it.
  /// `place`: where the machine is in it, if that is known.
  void putStill(hal::Result<hal::Image> still,
                const std::optional<inspection::TemplatePose>& place = {});

  /// Takes what the worker has done, and reads the procedure again when its files have changed, at
  /// most twice a second.
  void poll();
  /// Whether an answer is being written or waits for its picture: another would be refused.
  bool isBusy() const { return moves_ || stills_.hasAnswer(); }
  /// Waits until all that was answered is on the disk, or has failed. For tests.
  void finish();
  /// How the record's thread was left.
  enum class RecordEnd {
    kWritten,    ///< it has nothing left to do
    kIsReading,  ///< a procedure, and nothing else; it still uses this
    kIsWriting,  ///< it still uses this
  };
  /// The same for the end, and for at most `patience` of real time. Nothing is given afterwards. A
  /// procedure that was edited is not read any more.
  RecordEnd end(hal::Duration patience);

  /// Any thread.
  runtime::ProcedureStatus status() const;

 private:
  const SessionView& view() const { return worker_->view(); }
  const procedure::Stepper& stepper() const { return view().stepper; }
  bool isSignedOff() const { return view().isSignedOff; }
  bool isRecorded() const { return !options_.records.empty(); }
  bool pressForStep(const hal::KeyPressed& key);
  bool pressForValue(const hal::KeyPressed& key);
  bool obeyForStep(const procedure::StepCommand& command);
  bool isTooSoon(const std::string& source);
  bool isMoving();
  void goOn();
  bool say(procedure::StepCommandKind word);
  void giveValue();
  void answer(const procedure::Answer& answer);
  void wantStill(std::string when, std::optional<procedure::Answer> answer = std::nullopt);
  void commit(const procedure::Answer& answer, const std::string& by = {});
  void beginMove();
  void giveMove(StepWorker::Job job);
  void giveAside(StepWorker::Job job);
  void endMove(const hal::Result<record::Advance>& advance, procedure::Outcome outcome,
               bool isTold = false);
  void saveStill(const PendingStill& pending, hal::Image still);
  void compare(const PendingStill& pending, hal::Image still,
               const inspection::TemplatePose& place);
  void endComparison(const inspection::Inspection& inspection, const std::string& step);
  std::optional<record::PoseQuality> poseNow() const;
  void goBack();
  void changeOperator(const std::string& name);
  void signOff();
  void pressAbort();
  void readAgain();
  void note(std::string_view text) { put(notices_, text); }
  void fail(std::string_view text) { put(failures_, text); }
  static void put(std::deque<std::string>& texts, std::string_view text);
  /// What could not be written, or what was needed for that.
  enum class Unwritten { kAnswer, kStillOfAnswer, kOther };
  void noteFailure(const hal::Error& error, Unwritten what);
  const procedure::Notices& notices() const { return procedure::noticesIn(options_.language); }
  void publish();
  std::filesystem::file_time_type newestFile() const;

  LiveProcedureOptions options_;
  const hal::Clock& clock_;
  std::string typed_;  // digits of a value
  std::deque<std::string> notices_;
  std::deque<std::string> failures_;
  PendingStills stills_;
  std::optional<record::PoseQuality> pose_;
  hal::TimePoint located_;  // when pose_ was told
  bool mayJudge_ = false;   // the program was uncertain at this step
  bool moves_ = false;      // an answer, a way back or a sign-off is being written
  bool isReading_ = false;  // the procedure, again
  std::atomic<bool> isEnding_ = false;
  std::string source_;                   // of the input that is handled
  std::string moveSource_;               // of the last answer or step back
  std::optional<hal::TimePoint> moved_;  // when it was
  std::optional<hal::TimePoint> asked_;  // when a key asked to sign off before the end
  hal::TimePoint polled_;
  std::filesystem::file_time_type read_;
  mutable std::mutex mutex_;
  runtime::ProcedureStatus status_;   // under mutex_
  std::optional<StepWorker> worker_;  // the last member: what it is given may use the others
};

}  // namespace pleinair::app
