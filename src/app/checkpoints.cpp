#include "app/checkpoints.hpp"
#include "case_file/history_info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "app/stop.hpp"
#include "case_file/case_difference.hpp"
#include "case_file/case_file.hpp"
#include "core/error.hpp"
#include "core/log.hpp"
#include "io/seal.hpp"

namespace alphadot {

namespace {

namespace fs = std::filesystem;

constexpr Real seconds_between_looks = 0.5;  // for the stop file

std::string file_name(const std::string& path) {
  return fs::path(path).filename().string();
}

/// The case that a checkpoint was made with. Throws what keeps the present one from going on from it.
Case check_belongs(const RestartPoint& point, const Setup& setup) {
  const auto& info = point.head.history.info;
  if (info.mesh_hash != setup.mesh.hash)
    throw InputError(point.path, 0,
                     fmt::format("belongs to another mesh: its hash is {}, that of {} is {}", info.mesh_hash,
                                 setup.mesh.file, setup.mesh.hash),
                     "restart with the mesh that the checkpoint was made with");
  Case before = parse_case(info.case_text, point.path);
  const bool in_motion = point.head.phase == "motion";
  std::vector<Problem> problems;
  for (const auto& [key, there, here] :
       differences(before, setup.settings, in_motion ? Shared::steps : Shared::flow))
    problems.push_back({setup.settings.file, 0,
                        fmt::format("{} is {}, but the checkpoint was made with {}", key, here, there),
                        "restore the key, or run without --restart in another folder"});
  if (in_motion && info.motion_table_hash != setup.motion_table_hash)
    problems.push_back({setup.settings.motion.table_file, 0,
                        "the table has other content than when the checkpoint was made",
                        "restore the table, or run without --restart in another folder"});
  if (!problems.empty()) throw InputError(std::move(problems));
  return before;
}

}  // namespace

Checkpoints::Checkpoints(const Setup& setup, std::string folder, std::string stop_folder,
                         const Timer& since_start, const Communicator& comm)
    : setup_(setup),
      folder_(std::move(folder)),
      stop_folder_(std::move(stop_folder)),
      since_start_(since_start),
      comm_(comm),
      file_(setup.domain, comm),
      last_asked_(since_start.wall()),
      last_save_(since_start.wall()) {
  comm_.on_root([&] { in_folder_.emplace(folder_, setup_.settings.checkpoint.keep); });
}

void Checkpoints::leave_others_alone() {
  if (in_folder_) in_folder_->leave_alone();
}

void Checkpoints::begin_from(const std::string& file) {
  const Timer cost;
  RestartPoint point;
  comm_.on_root([&] {
    if (!file.empty()) {
      check_seal(file);
      point.path = file;
    } else if (!in_folder_->empty()) {
      std::vector<std::string> rejected;
      point = in_folder_->newest(rejected);
      for (const auto& reason : rejected) spdlog::warn("not taken: {}", reason);
    }
  });
  point.path = comm_.broadcast(point.path);
  if (point.path.empty()) {
    spdlog::warn("there is no checkpoint in {}: the run starts from the beginning", folder_);
    return;
  }
  comm_.on_all([&] {
    point.head = read_checkpoint_head(point.path);
    case_before_ = check_belongs(point, setup_);
  });
  const auto info = history_info(setup_.settings, setup_.mesh.hash, setup_.motion_table_hash);
  if (point.head.history.info.version != info.version)
    spdlog::warn("{} was written by alphadot {}: the run goes on, but not bit for bit", point.path,
                 point.head.history.info.version);
  point.head.history.info = info;
  spdlog::info("goes on from {}", point.path);
  restart_ = std::move(point);
  reading_.add(cost);
}

void Checkpoints::read(const std::vector<CheckpointField>& fields) {
  const Timer cost;
  file_.read_fields(restart_->path, fields);
  reading_.add(cost);
}

bool Checkpoints::found_stop_file() {
  const Real now = since_start_.wall();
  if (last_look_ >= 0 && now - last_look_ < seconds_between_looks) return false;
  last_look_ = now;
  std::error_code error;
  return fs::remove(fs::path(stop_folder_) / "stop", error);  // so that it does not stop the restarted run
}

bool Checkpoints::wall_limit_is_near() const {
  const Real limit = 60 * setup_.settings.checkpoint.wall_limit_minutes;
  constexpr Real files_at_the_end = 0.2;  // seconds
  const Real needed = 2 * longest_step_ + 2 * last_cost_ + files_at_the_end + 0.02 * limit;
  return limit > 0 && since_start_.wall() + needed > limit;
}

Reduction Checkpoints::reduction() {
  return {[this] { return asked_here(); }, [this](std::span<const Real> asked) { hear(asked); }};
}

std::vector<Real> Checkpoints::asked_here() {
  const auto number = [](bool yes) { return yes ? 1.0 : 0.0; };
  const Real interval = 60 * setup_.settings.checkpoint.minutes;
  const bool by_clock = comm_.is_root() && interval > 0 && since_start_.wall() - last_save_ > interval;
  return {number(take_checkpoint_signal() || by_clock), number(stop_signalled()),
          number(comm_.is_root() && found_stop_file()), number(comm_.is_root() && wall_limit_is_near())};
}

void Checkpoints::hear(std::span<const Real> asked) {
  if (asked[0] > 0) request_.save = true;
  if (request_.stop || asked[1] + asked[2] + asked[3] == 0) return;
  request_ = {true, true};
  if (asked[1] > 0) stop_reason_ = "stopped by a signal";
  if (asked[2] > 0) stop_reason_ = "stopped by the file \"stop\" in the run's folder";
  if (asked[3] > 0)
    stop_reason_ = fmt::format("stopped before the wall time limit of {} minutes",
                               setup_.settings.checkpoint.wall_limit_minutes);
}

Request Checkpoints::request(bool interval_is_over) {
  const Real now = since_start_.wall();
  longest_step_ = std::max(longest_step_, now - last_asked_);
  last_asked_ = now;
  if (interval_is_over) request_.save = true;
  return request_;
}

void Checkpoints::save(const CheckpointHead& head, const std::vector<CheckpointField>& fields) {
  const Timer cost;
  std::string path;
  if (comm_.is_root()) path = in_folder_->next_path();
  path = comm_.broadcast(path);
  request_.save = false;
  try {
    file_.write(path, head, fields);
  } catch (const InputError& error) {
    last_save_ = since_start_.wall();
    const std::string kept =
        latest_.empty() ? "there is none from this run yet" : "the last whole one is " + latest_;
    if (setup_.settings.checkpoint.on_failure == FailureAction::stop) {
      spdlog::warn("no checkpoint could be written; {}", kept);
      throw;
    }
    spdlog::warn("no checkpoint could be written, the run goes on; {}\n{}", kept, error.what());
    return;
  }
  latest_ = file_name(path);
  last_cost_ = cost.wall();
  last_save_ = since_start_.wall();
  spdlog::info("checkpoint {} ({:.2f} s)", latest_, last_cost_);
  if (comm_.is_root()) in_folder_->added();
  writing_.add(cost);
}

}  // namespace alphadot
