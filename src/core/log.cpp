#include "core/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>

#include <cstdio>

namespace alphadot {

void set_up_log(bool is_root, bool quiet) {
  auto logger =
      std::make_shared<spdlog::logger>("alphadot", std::make_shared<spdlog::sinks::stderr_color_sink_st>());
  logger->set_pattern("%v");
  logger->set_level(!is_root ? spdlog::level::off : quiet ? spdlog::level::warn : spdlog::level::info);
  spdlog::set_default_logger(logger);
}

void print_out(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);  // before the log's next words
}

}  // namespace alphadot
