#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "config/parameter.h"
#include "config/parameter_values.h"

namespace pleinair::config {

/// A parameter's descriptor and the member of P that holds it.
template <class P>
struct ParameterBinding {
  ParameterDescriptor descriptor;
  std::function<ParameterValue(const P&)> load;
  std::function<void(P&, const ParameterValue&)> store;
};

template <class P>
ParameterBinding<P> numberParameter(const std::string& name, double P::*member,
                                    const NumberRange& range, const std::string& help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = name, .help = help, .numberRange = range, .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<double>(value); }};
}

template <class P>
ParameterBinding<P> integerParameter(const std::string& name, int P::*member,
                                     const IntegerRange& range, const std::string& help,
                                     TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = name, .help = help, .integerRange = range, .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<int>(value); }};
}

template <class P>
ParameterBinding<P> switchParameter(const std::string& name, bool P::*member,
                                    const std::string& help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = name, .help = help, .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<bool>(value); }};
}

/// A member of an enumeration type, by name. `choices` must contain every value that P may hold.
template <class P, class E, std::size_t N>
ParameterBinding<P> choiceParameter(const std::string& name, E P::*member,
                                    const std::array<Choice<E>, N>& choices,
                                    const std::string& help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  std::vector<std::string> names = namesOf(choices);
  return {{.name = name, .help = help, .choices = std::move(names), .takesEffect = takesEffect},
          [member, choices](const P& p) {
            std::size_t index = 0;
            while (index < N && choices[index].value != p.*member) ++index;
            return ParameterValue(ChoiceIndex{index});
          },
          [member, choices](P& p, const ParameterValue& value) {
            p.*member = choices[std::get<ChoiceIndex>(value).index].value;
          }};
}

/// A member that is one of `names`, which are known at run time only.
template <class P>
ParameterBinding<P> choiceParameter(const std::string& name, std::string P::*member,
                                    const std::vector<std::string>& names, const std::string& help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = name, .help = help, .choices = names, .takesEffect = takesEffect},
          [member, names](const P& p) {
            const auto found = std::find(names.begin(), names.end(), p.*member);
            return ParameterValue(ChoiceIndex{static_cast<std::size_t>(found - names.begin())});
          },
          [member, names](P& p, const ParameterValue& value) {
            p.*member = names[std::get<ChoiceIndex>(value).index];
          }};
}

/// `allowed` and `takes` are ParameterDescriptor::textAllowed and takesText.
template <class P>
ParameterBinding<P> textParameter(const std::string& name, std::string P::*member,
                                  const std::string& allowed, const std::string& help,
                                  TakesEffect takesEffect = TakesEffect::kLive,
                                  const std::function<bool(std::string_view)>& takes = {}) {
  return {
      {.name = name,
       .help = help,
       .takesText = takes,
       .textAllowed = allowed,
       .takesEffect = takesEffect},
      [member](const P& p) { return ParameterValue(p.*member); },
      [member](P& p, const ParameterValue& value) { p.*member = std::get<std::string>(value); }};
}

/// A file or folder, or one of `words`. `ending` and `openWords` (openChoices) are those of
/// ParameterDescriptor.
template <class P>
ParameterBinding<P> pathParameter(const std::string& name, std::filesystem::path P::*member,
                                  const std::vector<std::string>& words, const std::string& help,
                                  TakesEffect takesEffect = TakesEffect::kRestart,
                                  const std::string& ending = {},
                                  const std::vector<std::string>& openWords = {}) {
  return {{.name = name,
           .help = help,
           .choices = words,
           .openChoices = openWords,
           .pathEnding = ending,
           .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) {
            p.*member = std::get<std::filesystem::path>(value);
          }};
}

/// Files or folders, each of which may also be one of `words`; `openWords` (openChoices), `allowed`
/// and `takes` (textAllowed and takesText, of each) as of ParameterDescriptor.
template <class P>
ParameterBinding<P> pathListParameter(const std::string& name,
                                      std::vector<std::filesystem::path> P::*member,
                                      LengthRange length, const std::vector<std::string>& words,
                                      const std::vector<std::string>& openWords,
                                      const std::string& help, const std::string& allowed = {},
                                      const std::function<bool(std::string_view)>& takes = {},
                                      TakesEffect takesEffect = TakesEffect::kRestart) {
  return {{.name = name,
           .help = help,
           .lengthRange = length,
           .choices = words,
           .openChoices = openWords,
           .takesText = takes,
           .textAllowed = allowed,
           .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) {
            p.*member = std::get<std::vector<std::filesystem::path>>(value);
          }};
}

/// A size; with a `word`, that stands for 0x0.
template <class P>
ParameterBinding<P> sizeParameter(const std::string& name, PixelSize P::*member,
                                  const SizeRange& range, const std::vector<std::string>& word,
                                  const std::string& help,
                                  TakesEffect takesEffect = TakesEffect::kRestart) {
  return {
      {.name = name, .help = help, .sizeRange = range, .choices = word, .takesEffect = takesEffect},
      [member](const P& p) { return ParameterValue(p.*member); },
      [member](P& p, const ParameterValue& value) { p.*member = std::get<PixelSize>(value); }};
}

/// The parameters of one style or part of the program, bound to the members of its struct P, whose
/// initialisers are the defaults:
///
///     struct WatercolorParameters { double cellSize = 8; bool paper = true; };
///     const ParameterTable<WatercolorParameters>& watercolorParameters() {
///       static const ParameterTable<WatercolorParameters> table{
///           numberParameter("cell_size", &WatercolorParameters::cellSize,
///                           {.min = 2, .max = 64, .unit = "px"}, "Side of a Voronoi cell."),
///           switchParameter("paper", &WatercolorParameters::paper, "Lay the picture on paper."),
///       };
///       return table;
///     }
///
/// A style hands out `defaults()`, which the program changes knowing no P, and calls `typed()` on
/// the parameter set of each frame. Immutable; any thread.
template <class P>
class ParameterTable {
 public:
  ParameterTable(std::initializer_list<ParameterBinding<P>> bindings) : bindings_(bindings) {
    const P defaults;
    std::vector<ParameterDescriptor> descriptors;
    for (ParameterBinding<P>& each : bindings_) {
      each.descriptor.defaultValue = each.load(defaults);
      descriptors.push_back(each.descriptor);
    }
    list_ = std::make_shared<const ParameterList>(std::move(descriptors));
  }

  ParameterValues defaults() const { return ParameterValues(list_); }

  /// Converts values of this table's list to the struct. Allocates nothing itself.
  P typed(const ParameterValues& values) const {
    assert(&values.list() == list_.get());
    P p;
    for (std::size_t i = 0; i < bindings_.size(); ++i) bindings_[i].store(p, values.at(i));
    return p;
  }

  /// Converts the struct to values, for host programs. Throws a ConfigError, with `origin` as the
  /// file, if a member is out of range.
  ParameterValues valuesOf(const P& p, const std::string& origin) const {
    ParameterValues values = defaults();
    for (std::size_t i = 0; i < bindings_.size(); ++i) {
      const ParameterDescriptor& descriptor = bindings_[i].descriptor;
      const ParameterValue value = bindings_[i].load(p);
      if (!descriptor.allows(value)) {
        const bool named = descriptor.kind() != ParameterKind::kChoice;
        throw ConfigError({.file = origin,
                           .key = descriptor.name,
                           .found = named ? descriptor.textOf(value) : "a value without a name",
                           .allowed = descriptor.allowed()});
      }
      values = values.with(i, value, origin);
    }
    return values;
  }

 private:
  std::vector<ParameterBinding<P>> bindings_;
  std::shared_ptr<const ParameterList> list_;
};

}  // namespace pleinair::config
