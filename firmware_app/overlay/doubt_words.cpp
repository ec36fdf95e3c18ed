#include "firmware_app/overlay/doubt_words.h"

#include "pipeline/procedure/words.h"

namespace pleinair::app {

std::string_view wordsOf(overlay::Doubt doubt, std::string_view language) {
  const procedure::Words& words = procedure::wordsIn(language);
  switch (doubt) {
    case overlay::Doubt::kNone:
      return {};
    case overlay::Doubt::kNotSeen:
      return words.noTag;
    case overlay::Doubt::kCarried:
      return words.tagCovered;
    case overlay::Doubt::kUncertain:
      return words.moveCloser;
    case overlay::Doubt::kOutOfView:
      return words.notInView;
    case overlay::Doubt::kOtherMachine:
      return words.otherTag;
    case overlay::Doubt::kContradicted:
      return words.tagsContradict;
  }
  return {};
}

}  // namespace pleinair::app
