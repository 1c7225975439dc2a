// SPDX-License-Identifier: Apache-2.0
// Copyright Caplet authors
//
// Stands in for Open Image Denoise, with the functions that are used of it, and says by numbers
// what it was asked: albedo comes back doubled, normals tripled, and colour as colour / 2 + albedo
// / 4 + normal / 8. Guides are to be asked for with quality 5 (balanced), colour with 6 (high) or
// what FAKE_OIDN_QUALITY says. With FAKE_OIDN_FAILS each filter fails.
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  const char* error;
} Device;

typedef struct {
  Device* device;
  float *color, *albedo, *normal, *output;
  size_t pixels;
  bool hdr, clean, is_ready;
  int quality;
  bool (*ask)(void*, double);
  void* user;
} Filter;

Device* oidnNewDevice(int type) {
  Device* device = calloc(1, sizeof(Device));
  if (type != 1) device->error = "not a CPU";
  return device;
}
void oidnSetDeviceBool(Device* device, const char* name, bool value) {
  if (strcmp(name, "setAffinity") != 0 || value) device->error = "unexpected setting of the device";
}
int oidnGetDeviceInt(Device* device, const char* name) {
  (void)device;
  return strcmp(name, "versionMajor") == 0 ? 2 : strcmp(name, "versionMinor") == 0 ? 9 : 7;
}
void oidnCommitDevice(Device* device) { (void)device; }
int oidnGetDeviceError(Device* device, const char** message) {
  if (!device->error) return 0;
  *message = device->error;
  device->error = NULL;
  return 1;
}
void oidnReleaseDevice(Device* device) { free(device); }

Filter* oidnNewFilter(Device* device, const char* type) {
  Filter* filter = calloc(1, sizeof(Filter));
  filter->device = device;
  if (strcmp(type, "RT") != 0) device->error = "unknown filter";
  return filter;
}
void oidnSetSharedFilterImage(Filter* filter, const char* name, void* pixels, int format,
                              size_t width, size_t height, size_t offset, size_t pixel_bytes,
                              size_t row_bytes) {
  float** to = strcmp(name, "color") == 0    ? &filter->color
               : strcmp(name, "albedo") == 0 ? &filter->albedo
               : strcmp(name, "normal") == 0 ? &filter->normal
               : strcmp(name, "output") == 0 ? &filter->output
                                             : NULL;
  if (!to || format != 3 || offset || pixel_bytes || row_bytes) {
    filter->device->error = "unexpected image";
    return;
  }
  *to = pixels;
  filter->pixels = width * height;
}
void oidnSetFilterBool(Filter* filter, const char* name, bool value) {
  if (strcmp(name, "hdr") == 0) filter->hdr = value;
  if (strcmp(name, "cleanAux") == 0) filter->clean = value;
}
void oidnSetFilterInt(Filter* filter, const char* name, int value) {
  if (strcmp(name, "quality") == 0) filter->quality = value;
}
void oidnSetFilterProgressMonitorFunction(Filter* filter, bool (*ask)(void*, double), void* user) {
  filter->ask = ask;
  filter->user = user;
}
void oidnCommitFilter(Filter* filter) { filter->is_ready = true; }
void oidnExecuteFilter(Filter* filter) {
  if (filter->ask && !filter->ask(filter->user, 0.5)) {
    filter->device->error = "cancelled";
    return;
  }
  if (getenv("FAKE_OIDN_FAILS")) filter->device->error = "as it was told to";
  const bool is_guided = filter->albedo && filter->normal;
  const char* asked = getenv("FAKE_OIDN_QUALITY");
  const int quality = !filter->color ? 5 : asked ? atoi(asked) : 6;
  if (!filter->output || !filter->is_ready || filter->quality != quality ||
      filter->hdr != (filter->color != NULL) || filter->clean != (filter->color && is_guided)) {
    filter->device->error = "unexpected settings of the filter";
    return;
  }
  for (size_t i = 0; i < 3 * filter->pixels; ++i) {
    if (!filter->color)
      filter->output[i] = filter->albedo ? 2 * filter->albedo[i] : 3 * filter->normal[i];
    else
      filter->output[i] =
          filter->color[i] / 2 + (is_guided ? filter->albedo[i] / 4 + filter->normal[i] / 8 : 0.0f);
  }
}
void oidnReleaseFilter(Filter* filter) { free(filter); }
