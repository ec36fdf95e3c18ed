#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "firmware_app/overlay/step_content.h"
#include "firmware_app/repair_station/pending_stills.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"
#include "hal/key_pressed.h"
#include "pipeline/inspection/template_file.h"
#include "pipeline/procedure/step_command.h"
#include "pipeline/procedure/stepper.h"
#include "pipeline/record/work_session.h"
#include "pipeline/runtime/procedure_status.h"

namespace pleinair::app {

struct LiveProcedureOptions {
  std::filesystem::path folder;
  std::string language;           ///< empty: the procedure's first
  std::filesystem::path records;  ///< the folder of records; empty: nothing is recorded
  std::string operatorName;       ///< empty: unnamed, or whoever the resumed record names
  std::string workOrder;
  std::string program;         ///< version of this program
  bool stillsOfSteps = false;  ///< a still before and after each step, beside those of checks
};

/// A procedure that is carried out while painting goes on: keys in, steps and a record out. Main
/// thread, unless said otherwise.
///
/// Page Down, which pedals and presenters send, ends a step; Page Up goes back; y and n answer;
/// digits and Enter give a value; Enter signs off at the end, Shift-X before it. Page Down answers
/// no question: a check is not passed by going on.
///
/// Of two inputs at once one counts: after an answer or a step back, other inputs are ignored for
/// kOneAtATime, for whoever used them has not seen the new step.
class LiveProcedure {
 public:
  static constexpr hal::Duration kOneAtATime = std::chrono::milliseconds(400);
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
  /// What has happened since the last call, for the caption and the log: a check that failed, a
  /// full disk, a mistake in an edited procedure.
  std::optional<std::string> takeNotice();

  /// The version in force.
  const procedure::Procedure& procedure() const { return stepper().procedure(); }

  /// Whether a still of the camera is wanted, asked once for each.
  bool takeStillRequest();
  /// Takes the still that was wanted: saves it, and ends the step that waited for it.
  /// `place`: where the machine is in it, if that is known.
  void putStill(const hal::Result<hal::Image>& still,
                const std::optional<inspection::TemplatePose>& place = {});

  /// Reads the procedure again when its files have changed, at most twice a second.
  void poll();

  /// Any thread.
  runtime::ProcedureStatus status() const;

 private:
  void begin(std::shared_ptr<const procedure::Procedure> procedure);
  const procedure::Stepper& stepper() const;
  std::string requestAtEnd() const;
  bool isSignedOff() const { return session_ && session_->record().isSignedOff(); }
  bool pressForStep(const hal::KeyPressed& key);
  bool pressForValue(const hal::KeyPressed& key);
  bool obeyForStep(const procedure::StepCommand& command);
  bool isTooSoon(const std::string& source);
  void goOn();
  bool say(procedure::StepCommandKind word);
  void giveValue();
  void answer(const procedure::Answer& answer);
  void wantStill(std::string when, std::optional<procedure::Answer> answer = std::nullopt);
  void wantStillBefore();
  void commit(const procedure::Answer& answer, const std::string& by = {});
  bool comparesByItself() const;
  void compare(const hal::Image& still, const std::optional<inspection::TemplatePose>& place);
  std::optional<record::PoseQuality> poseNow() const;
  void goBack();
  void changeOperator(const std::string& name);
  void signOff();
  void note(const std::string& text) { notice_ = text; }
  void publish();
  std::filesystem::file_time_type newestFile() const;

  LiveProcedureOptions options_;
  const hal::Clock& clock_;
  std::optional<record::WorkSession> session_;
  std::optional<procedure::Stepper> unrecorded_;  // without a record
  std::string typed_;                             // digits of a value
  std::optional<std::string> notice_;
  PendingStills stills_;
  std::optional<record::PoseQuality> pose_;
  hal::TimePoint located_;               // when pose_ was told
  bool mayJudge_ = false;                // the program was uncertain at this step
  std::string source_;                   // of the input that is handled
  std::string moveSource_;               // of the last answer or step back
  std::optional<hal::TimePoint> moved_;  // when it was
  hal::TimePoint polled_;
  std::filesystem::file_time_type read_;
  mutable std::mutex mutex_;
  runtime::ProcedureStatus status_;  // under mutex_
};

}  // namespace pleinair::app
