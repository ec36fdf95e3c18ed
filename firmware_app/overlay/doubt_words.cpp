#include "firmware_app/overlay/doubt_words.h"

namespace pleinair::app {

std::string wordsOf(overlay::Doubt doubt, std::string_view language) {
  const bool isGerman = language.starts_with("de");
  switch (doubt) {
    case overlay::Doubt::kNone:
      return {};
    case overlay::Doubt::kNotSeen:
      return isGerman ? "Kein Tag der Maschine im Bild" : "No tag of the machine in view";
    case overlay::Doubt::kCarried:
      return isGerman ? "Tag verdeckt" : "The tag is covered";
    case overlay::Doubt::kUncertain:
      return isGerman ? "Lage zu ungenau: näher herangehen" : "Place too uncertain: move closer";
    case overlay::Doubt::kOutOfView:
      return isGerman ? "Teil nicht im Bild" : "The part is not in view";
    case overlay::Doubt::kOtherMachine:
      return isGerman ? "Tag einer anderen Maschine" : "Tag of another machine";
  }
  return {};
}

}  // namespace pleinair::app
