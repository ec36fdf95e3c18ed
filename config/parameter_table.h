#pragma once

#include <array>
#include <cassert>
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
ParameterBinding<P> numberParameter(std::string name, double P::*member, const NumberRange& range,
                                    std::string help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = std::move(name),
           .help = std::move(help),
           .numberRange = range,
           .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<double>(value); }};
}

template <class P>
ParameterBinding<P> integerParameter(std::string name, int P::*member, const IntegerRange& range,
                                     std::string help,
                                     TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = std::move(name),
           .help = std::move(help),
           .integerRange = range,
           .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<int>(value); }};
}

template <class P>
ParameterBinding<P> switchParameter(std::string name, bool P::*member, std::string help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  return {{.name = std::move(name), .help = std::move(help), .takesEffect = takesEffect},
          [member](const P& p) { return ParameterValue(p.*member); },
          [member](P& p, const ParameterValue& value) { p.*member = std::get<bool>(value); }};
}

/// A member of an enumeration, by name. Every value that P may hold is among `choices`.
template <class P, class E, std::size_t N>
ParameterBinding<P> choiceParameter(std::string name, E P::*member,
                                    const std::array<Choice<E>, N>& choices, std::string help,
                                    TakesEffect takesEffect = TakesEffect::kLive) {
  std::vector<std::string> names;
  for (const Choice<E>& each : choices) names.emplace_back(each.name);
  return {{.name = std::move(name),
           .help = std::move(help),
           .choices = std::move(names),
           .takesEffect = takesEffect},
          [member, choices](const P& p) {
            std::size_t index = 0;
            while (index < N && choices[index].value != p.*member) ++index;
            return ParameterValue(ChoiceIndex{index});
          },
          [member, choices](P& p, const ParameterValue& value) {
            p.*member = choices[std::get<ChoiceIndex>(value).index].value;
          }};
}

/// The parameters of one style, bound to the members of its struct P, whose initialisers are the
/// defaults:
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
/// the snapshot that comes with each frame. Immutable; any thread.
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

  /// The values, which are of this table's list, as the struct. Allocates nothing of its own.
  P typed(const ParameterValues& values) const {
    assert(&values.list() == list_.get());
    P p;
    for (std::size_t i = 0; i < bindings_.size(); ++i) bindings_[i].store(p, values.at(i));
    return p;
  }

  /// The struct as values, for host programs. Throws a ConfigError, with `origin` for the file,
  /// where a member is out of its range.
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
