#include "analysis/force_history.hpp"

#include "core/error.hpp"

namespace alphadot {

namespace {

std::vector<Real> series(const std::vector<Coefficients>& values, int coefficient) {
  std::vector<Real> out;
  out.reserve(values.size());
  for (const auto& value : values) out.push_back(value[coefficient]);
  return out;
}

}  // namespace

void ForceHistory::validate() const {
  const auto complete = [&](const auto& values) { return values.empty() || values.size() == time.size(); };
  if (loads.size() != time.size() || !complete(angle) || !complete(bounds))
    throw InputError("", 0, "force history: times, angles, loads and bounds differ in number",
                     "the record is incomplete: write it again, one entry a step");
}

std::vector<Real> ForceHistory::load(int coefficient) const {
  return series(loads, coefficient);
}

std::vector<Real> ForceHistory::bound(int coefficient) const {
  return series(bounds, coefficient);
}

}  // namespace alphadot
