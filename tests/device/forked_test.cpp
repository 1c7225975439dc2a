// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// What is given back to OpenCL in forked processes. A GPU's driver shares its files with the
// parent: there the child would free what the parent uses.
#include "device/forked.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "device/opencl.h"

namespace caplet {
namespace {

int released = 0;

cl_int CL_API_CALL release(cl_mem) {
  ++released;
  return CL_SUCCESS;
}

/// Exit code of a forked process that calls it.
template <class Work>
int in_fork(Work&& work) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(work());
  int status = 0;
  ::waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int released_now() {
  give_back(release, cl_mem());
  return released;
}

TEST(Forked, GivesNothingBackThatTheParentMayUse) {
  // In a process of its own, for this one is then one that has used OpenCL.
  EXPECT_EQ(in_fork([] {
              if (in_fork(released_now) != 1) return 1;  // not used yet
              begin_opencl();
              if (in_fork(released_now) != 0) return 2;
              if (in_fork([] { return in_fork(released_now); }) != 0) return 3;
              return released_now() == 1 ? 0 : 4;
            }),
            0);
}

}  // namespace
}  // namespace caplet
