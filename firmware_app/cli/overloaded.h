#pragma once

namespace pleinair::app {

/// A visitor for std::visit, made of lambdas.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace pleinair::app
