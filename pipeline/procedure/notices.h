#pragma once

#include <span>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace pleinair::procedure {

/// What the program tells somebody who carries a procedure out, in one language. "{}" stands for
/// names, values and texts of the system; its number is the same in all languages.
struct Notices {
  std::string_view language;  ///< "de"
  // Of the record.
  std::string_view resumed, signedOff, aborted, abortAgain, isSignedOff, readAgain, isWriting,
      diskFull, pictureNotSaved, wasEdited, notRecorded;
  // Of operators.
  std::string_view noOperator, worksAlready, nowWorks;
  // Of answers.
  std::string_view asksQuestion, typeValue, doAgain, otherAnswer, atTheEnd, stepsLeft;
  // Of pictures and comparisons.
  std::string_view awaitsPicture, noPicture, pictureDecides, notLocated, uncertain, mayJudge;
  // Why a comparison is uncertain.
  std::string_view otherSide, notWholly, comeCloser, nothingToCompare, tooDark, almostAlike;
  std::string_view movieUnreadable;  ///< in its place
  // Of inputs, and their names.
  std::string_view twoInputs, inputReady, inputGone, theKeys, aCard, theServer;
  // What the keys do, for the help.
  std::string_view keyNext, keyBack, keyAnswer, keyValue, keySignOff, keyAbort, digits;
};

/// In the language's first part ("de-AT": "de") where the program has it, else in English.
const Notices& noticesIn(std::string_view language);
/// A notice with its values in the places of "{}". Precondition: it has as many.
template <class... Values>
std::string filled(std::string_view notice, const Values&... values) {
  return fmt::format(fmt::runtime(notice), values...);
}
/// All that the program has, English first.
std::span<const Notices> allNotices();

}  // namespace pleinair::procedure
