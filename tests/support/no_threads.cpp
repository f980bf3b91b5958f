// Makes pthread_create() abort the program. Linked into every test that is not marked THREADS in
// tests/CMakeLists.txt: the thread sanitizer does not run such tests, so neither they nor the code
// they test may start a thread.
#include <cstdio>
#include <cstdlib>

#include <pthread.h>

// The linker finds this definition in the executable before the C library's.
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
