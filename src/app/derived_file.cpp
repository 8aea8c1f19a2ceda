#include "app/derived_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/error.hpp"
#include "derivatives/extraction.hpp"
#include "io/history.hpp"
#include "io/result.hpp"

namespace alphadot {

namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw InputError(file, 0, what,
                   "give the history.h5 of a motion, or the result.json of run or derivatives");
}

/// The columns of a result; entries that symmetry makes zero are not in it.
EstimatedDerivatives columns_of(const Result& result, const std::string& file) {
  EstimatedDerivatives out;
  for (const auto& part : result.derivatives.begin()->second.parts) out.parts.push_back({part.first, {}});
  for (const auto& [name, entry] : result.derivatives) {
    const auto found = derivative_of_name(name, result.verb == "derivatives");
    if (!found) refuse(file, fmt::format("{} is no stability derivative of the whole configuration", name));
    const auto [coefficient, variable] = *found;
    out.derivatives[variable][coefficient] = {entry.value, entry.uncertainty};
    if (!entry.converged) out.unconverged.insert(variable);
    const auto same = [](const UncertaintyPart& a, const auto& b) { return a.source == b.first; };
    if (!std::ranges::equal(out.parts, entry.parts, same))
      refuse(file, fmt::format("the uncertainty of {} has other parts than the first one's", name));
    for (std::size_t i = 0; i < entry.parts.size(); ++i)
      out.parts[i].half_width[variable][coefficient] = entry.parts[i].second;
  }
  return out;
}

/// The steady loads of a result, which has them in this order.
Coefficients loads_of(const Result& result) {
  Coefficients out;
  for (int i = 0; i < out.size(); ++i) out[i] = result.forces.at(static_cast<std::size_t>(i)).second;
  return out;
}

/// The loads of every step.
std::vector<Coefficients> loads_of(const History& history) {
  std::vector<Coefficients> out(history.steps());
  for (int i = 0; i < Coefficients::size(); ++i) {
    const auto& column =
        history.column(fmt::format("total/{}", coefficient_names[static_cast<std::size_t>(i)]));
    for (std::size_t step = 0; step < out.size(); ++step) out[step][i] = column[step];
  }
  return out;
}

DerivedFile from_result(const std::string& file) {
  const Result result = read_result(file);
  if (result.verb != "run" && result.verb != "derivatives")
    refuse(file, fmt::format("this is a result of the verb {}", result.verb));
  if (result.derivatives.empty())
    refuse(file, fmt::format("holds no derivatives: the run ended as {}{}{}", to_string(result.status),
                             result.message.empty() ? "" : ": ", result.message));
  std::set<std::string> methods;
  for (const auto& [name, entry] : result.derivatives) methods.insert(entry.method);
  return {file,
          to_string(result.status),
          result.message,
          result.reference,
          {result.freestream, result.mesh.file, result.mesh.hash, result.provenance.version},
          fmt::format("{}", fmt::join(methods, "; ")),
          columns_of(result, file),
          {loads_of(result)}};
}

DerivedFile from_history(const std::string& file) {
  const History history = read_history(file);
  const auto& info = history.info;
  Extraction extraction;
  try {
    extraction = extract_derivatives(history);
  } catch (const InputError& error) {
    const auto& problem = error.problems().front();
    throw InputError(file, 0, problem.what, problem.remedy);
  }
  if (extraction.estimated.derivatives.empty())
    refuse(file,
           fmt::format("holds no derivatives: a motion of kind {} yields none", word_of(info.motion.kind)));
  const auto end = std::min(info.status.find(": "), info.status.size());
  DerivedFile out{file,
                  info.status.substr(0, end),
                  end < info.status.size() ? info.status.substr(end + 2) : "",
                  info.reference,
                  info.origin(),
                  extraction.method,
                  std::move(extraction.estimated),
                  loads_of(history)};
  if (out.status == to_string(RunStatus::unconverged))
    for (const auto& [variable, column] : out.estimated.derivatives)
      out.estimated.unconverged.insert(variable);
  return out;
}

}  // namespace

DerivedFile read_derivatives(const std::string& file) {
  return std::filesystem::path(file).extension() == ".json" ? from_result(file) : from_history(file);
}

}  // namespace alphadot
