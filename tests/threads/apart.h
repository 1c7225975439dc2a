// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Processes in which no OpenCL has been used, and what is rendered there.
#pragma once

#include <caplet/device.h>
#include <caplet/film.h>
#include <caplet/scene.h>
#include <gtest/gtest.h>
#include <sys/types.h>

#include <functional>
#include <string>

namespace caplet::test {

/// Calls `work` in a forked process, which then ends by _exit: at an exit log4cplus, which Debian
/// 12's OpenImageIO brings, waits for threads that a child does not have. Empty when that goes
/// well; else what `work` threw, or how the process ended, or that it took more than `seconds`.
std::string apart(const std::function<void()>& work, double seconds = 120);

/// How a child process ends: empty when it ends by itself with exit code 0. Kills it when it takes
/// more than `seconds`.
std::string end_of(pid_t child, double seconds);

/// Times that a scene is played: 5, or so many times as much (CAPLET_TEST_SCALE).
int times();

/// Throws std::runtime_error.
void require(bool holds, const std::string& what);

/// The device that tests are to use.
Device device();

/// A ball, a box and two capsules in studio light, 24 x 16 pixels.
Scene small_scene();

/// Whether both have the same channels of the same bits.
bool equal(const Film& a, const Film& b);

}  // namespace caplet::test
