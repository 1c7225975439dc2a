// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// A driver that ends the program that loads it.
#include <stdio.h>
#include <stdlib.h>

__attribute__((constructor)) static void crash(void) {
  fprintf(stderr, "this driver is broken\n");
  abort();
}
