// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// The main program: dispatches subcommands and returns exit codes (0 done, 1 failed while working,
// 2 wrong input or usage, 3 `verify` found disagreement, 75 a stopped render's film is kept).
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <new>
#include <system_error>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/interrupt.h"
#include "base/log.h"
#include "base/utf8.h"
#include "cli/commands.h"
#include "cli/description.h"
#include "cli/usage_errors.h"
#include "device/cl_error.h"
#include "device/compilers.h"
#include "device/second_try.h"
#include "render/session.h"

namespace {

constexpr int exit_failed = 1, exit_wrong_input = 2;

/// Prints one line. Control characters of names and files, which could break the line or the
/// terminal, become blanks.
void print_error(const std::string& message) {
  std::fprintf(stderr, "caplet: error: %s\n", caplet::one_line(message).c_str());
}

int print_usage_error(const CLI::App& app, const CLI::ParseError& error) {
  print_error(caplet::cli::usage_error(app, error));
  std::string help = "caplet --help";
  for (const CLI::App* command : app.get_subcommands())
    help = "caplet " + command->get_name() + " --help";
  std::fprintf(stderr, "caplet: see: %s\n", help.c_str());
  return exit_wrong_input;
}

/// If a standard stream is closed, its number would be given to the next opened file. A closed
/// stdout is replaced by one that cannot be written, which end() reports.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 &&
        ::open("/dev/null", stream == STDOUT_FILENO ? O_RDONLY : O_RDWR) != stream)
      return;
}

/// Returns whether stdout is a pipe that nobody reads any more, as after `| head`.
bool reader_has_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return ::poll(&out, 1, 0) > 0 && (out.revents & POLLERR) != 0;
}

/// Returns `code`, or exit_failed when results did not reach stdout.
int end(int code) {
  errno = 0;
  if (std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.flush()) return code;
  if (reader_has_gone()) return exit_failed;
  print_error(fmt::format("stdout cannot be written: {}",
                          errno ? std::strerror(errno) : "not all of it was taken"));
  return exit_failed;
}

int run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::RuntimeError& end) {  // a command's own exit code; its output is complete
    return end.get_exit_code();
  } catch (const CLI::ParseError& error) {
    return print_usage_error(app, error);
  } catch (const caplet::InputError& error) {
    for (const std::string& message : error.messages()) print_error(message);
    return exit_wrong_input;
  } catch (const caplet::DriverError& error) {
    // A driver's compiler may fail because of the signal; the interrupt is then the reason, not the
    // driver.
    if (caplet::interrupt_requested()) {
      print_error("interrupted; nothing is written");
    } else {
      caplet::SecondTry::after(error);
      print_error(error.what());
    }
  } catch (const std::bad_alloc&) {
    print_error("out of memory");
  } catch (const std::system_error& error) {  // of fmt::print
    if (error.code() != std::errc::broken_pipe || !reader_has_gone()) print_error(error.what());
  } catch (const std::exception& error) {
    print_error(error.what());
  }
  return exit_failed;
}

int whole_program(int argc, char** argv) {
  open_standard_streams();
  caplet::log::set_quiet(false);
  // A closed pipe and the file size limit become write errors, not signals: other outputs remain,
  // and files must be removed.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
  caplet::set_compiler_program("/proc/self/exe");
  const caplet::SecondTry second_try(argv);
  const caplet::NotedInputs inputs;
  const caplet::cli::Invocation invocation{{argv, argv + argc}};
  CLI::App app{
      "Caplet renders scenes of exact analytic solids, capsules first, by path tracing on any "
      "OpenCL device.",
      "caplet"};
  app.set_version_flag("--version", "caplet " CAPLET_VERSION, "Show the version and exit")
      ->group("Options");
  caplet::cli::use_help_text(app);
  app.set_help_flag("-h,--help", "Show this help and exit")->group("Options");
  app.require_subcommand(1);
  app.footer(caplet::cli::footer_with(
      {"caplet render scene.pbrt -o picture.exr --preview picture.png"},
      "`caplet help COMMAND` explains a command.\n"
      "Exit codes: 0 done, 1 failed while working, 2 the input or the "
      "usage is wrong, 3 verify found disagreement, 75 a render was stopped "
      "and its film is kept."));
  caplet::cli::add_render(app, invocation);
  caplet::cli::add_merge(app, invocation);
  caplet::cli::add_film(app);
  caplet::cli::add_pick(app);
  caplet::cli::add_verify(app);
#ifdef CAPLET_WITH_VIEW
  caplet::cli::add_view(app);
#endif
  caplet::cli::add_info(app);
  caplet::cli::add_convert(app);
  caplet::cli::add_build(app);
  caplet::cli::add_devices(app);
  caplet::cli::add_doctor(app);
  caplet::cli::add_bench(app, invocation);
  caplet::cli::add_help(app);
  caplet::cli::add_try_device(app);
  caplet::cli::add_compile(app);
  caplet::cli::add_describe(app);
  return end(run(app, argc, argv));
}

}  // namespace

int main(int argc, char** argv) {
  const int code = whole_program(argc, argv);
  if (caplet::any_thread_given_up() || caplet::any_driver_error()) std::_Exit(code);
  return code;
}
