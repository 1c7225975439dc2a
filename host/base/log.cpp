// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
#include "base/log.h"

#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_sinks.h>

#include <atomic>
#include <mutex>

namespace caplet::log {

namespace {

std::atomic<int> errors{0};

class CountingSink : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (message.level >= spdlog::level::err) ++errors;
  }
  void flush_() override {}
};

struct Setup {
  Setup() {
    auto console = std::make_shared<spdlog::sinks::stderr_sink_mt>();
    auto counter = std::make_shared<CountingSink>();
    auto logger = std::make_shared<spdlog::logger>("caplet", spdlog::sinks_init_list{console, counter});
    logger->set_pattern("caplet: %^%l%$: %v");
    spdlog::set_default_logger(logger);
  }
} setup;

}  // namespace

void set_quiet(bool quiet) { spdlog::set_level(quiet ? spdlog::level::warn : spdlog::level::info); }
int error_count() { return errors; }

}  // namespace caplet::log
