// Preloaded by same_flight_test: makes Embree use the instruction set that KARST_TEST_EMBREE_ISA names.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>

void* rtcNewDevice(const char* config);
void* rtcNewDevice(const char* config) {
  void* (*make)(const char*);
  *(void**)&make = dlsym(RTLD_NEXT, "rtcNewDevice");
  char forced[200];
  snprintf(forced, sizeof forced, "%s,isa=%s", config, getenv("KARST_TEST_EMBREE_ISA"));
  fprintf(stderr, "ray caster made with isa=%s\n", getenv("KARST_TEST_EMBREE_ISA"));
  return make(forced);
}
