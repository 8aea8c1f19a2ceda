#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/error.hpp"
#include "io/files.hpp"
#include "io/result.hpp"

namespace alphadot {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 28;  // components of a mesh of many patches
constexpr const char* remedy = "give the result.json of a run's folder";

/// An object of the file with its place in it, for messages: "derivatives.Cm_alpha".
class Node {
 public:
  Node(const std::string& file, const Json& json, std::string place)
      : file_(file), json_(json), place_(std::move(place)) {
    if (!json_.is_object()) fail("is not an object");
  }

  Node object(const std::string& key) const { return {file_, at(key), within(key)}; }
  Real number(const std::string& key) const { return number(at(key), key); }
  /// A half width; null, of which nothing is known, is infinite.
  Real half_width(const std::string& key) const {
    return at(key).is_null() ? std::numeric_limits<Real>::infinity() : number(key);
  }
  std::string text(const std::string& key) const {
    if (!at(key).is_string()) Node::fail(within(key), "is not text");
    return at(key).get<std::string>();
  }
  bool boolean(const std::string& key) const {
    if (!at(key).is_boolean()) fail(within(key), "is neither true nor false");
    return at(key).get<bool>();
  }
  Vec3 point(const std::string& key) const {
    const Json& list = at(key);
    if (!list.is_array() || list.size() != 3) fail(within(key), "is not a list of three numbers");
    return {number(list[0], key), number(list[1], key), number(list[2], key)};
  }
  std::vector<std::string> keys() const {
    std::vector<std::string> out;
    for (const auto& item : json_.items()) out.push_back(item.key());
    return out;
  }
  bool has(const std::string& key) const { return json_.contains(key); }
  [[noreturn]] void fail(const std::string& what) const { fail(place_, what); }

 private:
  const Json& at(const std::string& key) const {
    if (!has(key)) fail(within(key), "is missing");
    return json_.at(key);
  }
  std::string within(const std::string& key) const { return place_.empty() ? key : place_ + "." + key; }
  Real number(const Json& json, const std::string& key) const {
    if (!json.is_number())
      fail(within(key), json.is_null() ? "is null: no finite number" : "is not a number");
    return json.get<Real>();
  }
  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw InputError(file_, 0, fmt::format("{} {}", place.empty() ? "the whole" : place, what), remedy);
  }

  const std::string& file_;
  const Json& json_;
  std::string place_;
};

Json parsed(const std::string& path) {
  const std::string text = read_file(path, "result", most_bytes);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
    throw InputError(
        path, static_cast<int>(1 + std::count(text.begin(), end, '\n')),
        error.byte >= text.size() ? "the file is cut: its JSON ends too early" : "this is no JSON", remedy);
  }
}

RunStatus status_in(const Node& result) {
  using enum RunStatus;
  for (const auto status : {converged, completed, unconverged, interrupted, diverged, error})
    if (to_string(status) == result.text("status")) return status;
  result.fail(fmt::format("has an unknown status, {}", result.text("status")));
}

DerivativeResult derivative_in(const Node& entry) {
  DerivativeResult out{entry.number("value"), entry.half_width("uncertainty"), entry.text("method"),
                       entry.boolean("converged")};
  if (entry.has("parts")) {
    const Node parts = entry.object("parts");
    for (const auto& source : parts.keys()) out.parts.emplace_back(source, parts.half_width(source));
  }
  const auto is_negative = [](const auto& part) { return part.second < 0; };
  if (out.uncertainty < 0 || std::ranges::any_of(out.parts, is_negative))
    entry.fail("has a negative uncertainty");
  return out;
}

}  // namespace

Result read_result(const std::string& path) {
  const Json json = parsed(path);
  const Node root(path, json, "");
  Result out;
  out.status = status_in(root);
  out.message = root.text("message");
  out.title = root.text("title");
  out.verb = root.text("verb");
  out.uncertainty = root.text("uncertainty");
  out.mesh.file = root.object("mesh").text("file");
  out.mesh.hash = root.object("mesh").text("hash");
  const Node reference = root.object("reference"), stream = root.object("freestream");
  out.reference = {.length = reference.number("length"),
                   .area = reference.number("area"),
                   .moment_center = reference.point("moment_center"),
                   .half_model = reference.text("model") == "half"};
  if (!(out.reference.length > 0)) reference.fail("has a length that is not positive");
  out.rate = reference.text("rate");
  out.axes = reference.text("axes");
  out.freestream = {stream.number("mach"), stream.number("alpha"), stream.number("beta"),
                    stream.number("gamma")};
  const Node forces = root.object("forces");
  for (const char* name : {"CA", "CY", "CN", "Cl", "Cm", "Cn"})
    out.forces.emplace_back(name, forces.number(name));
  const Node derivatives = root.object("derivatives");
  for (const auto& name : derivatives.keys()) out.derivatives[name] = derivative_in(derivatives.object(name));
  out.provenance.version = root.object("provenance").text("version");
  return out;
}

}  // namespace alphadot
