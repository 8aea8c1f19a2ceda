#include "io/checkpoint_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "core/error.hpp"
#include "io/seal.hpp"

namespace alphadot {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "checkpoint_", suffix = ".vtkhdf";

/// The number of a checkpoint's file name, or nothing.
std::optional<int> number_of(std::string_view name) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return std::nullopt;
  const auto digits = name.substr(prefix.size(), name.size() - prefix.size() - suffix.size());
  int number = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc{} || end != digits.data() + digits.size() || number < 0) return std::nullopt;
  return number;
}

}  // namespace

bool is_checkpoint_name(std::string_view name) {
  return number_of(name).has_value();
}

CheckpointFolder::CheckpointFolder(std::string folder, int keep) : folder_(std::move(folder)), keep_(keep) {
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error))
    if (const auto number = number_of(entry->path().filename().string())) numbers_.push_back(*number);
  if (error) throw InputError(folder_, 0, "the folder of the run cannot be read: " + error.message());
  std::ranges::sort(numbers_);
  if (!numbers_.empty()) last_number_ = numbers_.back();
}

std::string CheckpointFolder::path_of(int number) const {
  return (fs::path(folder_) / fmt::format("{}{:06}{}", prefix, number, suffix)).string();
}

std::string CheckpointFolder::next_path() const {
  return path_of(last_number_ + 1);
}

void CheckpointFolder::added() {
  numbers_.push_back(++last_number_);
  std::error_code error;
  while (numbers_.size() > static_cast<std::size_t>(keep_)) {
    fs::remove(path_of(numbers_.front()), error);
    numbers_.erase(numbers_.begin());
  }
}

RestartPoint CheckpointFolder::newest(std::vector<std::string>& rejected) {
  std::vector<Problem> problems;
  while (!numbers_.empty()) {
    const auto path = path_of(numbers_.back());
    try {
      check_seal(path);
      return {path, read_checkpoint_head(path)};
    } catch (const InputError& error) {
      rejected.emplace_back(error.what());
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      numbers_.pop_back();
    }
  }
  problems.push_back({folder_, 0, "no checkpoint in the folder can be read",
                      "run without --restart in another folder: here it would replace them"});
  throw InputError(std::move(problems));
}

}  // namespace alphadot
