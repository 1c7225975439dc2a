// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A driver that never comes back; it writes its process into the file that CAPLET_TEST_PROCESS names.
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

__attribute__((constructor)) static void hang(void) {
  const char* path = getenv("CAPLET_TEST_PROCESS");
  FILE* file = path ? fopen(path, "w") : NULL;
  if (file) {
    fprintf(file, "%d\n", (int)getpid());
    fclose(file);
  }
  for (;;) pause();
}
