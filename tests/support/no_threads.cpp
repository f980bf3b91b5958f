// Linked into every test that does not say THREADS in tests/CMakeLists.txt: the thread sanitizer
// does not run these, so they must not start a thread, in their own code or in what they test.
#include <cstdio>
#include <cstdlib>

#include <pthread.h>

// The executable's own symbol is found before the C library's.
extern "C" int pthread_create(
    pthread_t*, const pthread_attr_t*, void* (*)(void*),
    void*) {  // NOLINT(readability-inconsistent-declaration-parameter-name)
  std::fputs(
      "This test starts a thread, so the thread sanitizer has to run it: add THREADS to its line "
      "in "
      "tests/CMakeLists.txt.\n",
      stderr);
  std::abort();
}
