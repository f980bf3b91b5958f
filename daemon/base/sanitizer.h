// Defines MERLIN_..._SANITIZER macros in a build with a sanitizer. Such a build reserves terabytes
// of address space, counts the sanitizer's memory as the program's, and is slow. g++ and clang
// announce a sanitizer differently; no other file checks for it.
#pragma once

#if defined(__SANITIZE_ADDRESS__)
#define MERLIN_ADDRESS_SANITIZER 1
#elif defined(__SANITIZE_THREAD__)
#define MERLIN_THREAD_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define MERLIN_ADDRESS_SANITIZER 1
#elif __has_feature(thread_sanitizer)
#define MERLIN_THREAD_SANITIZER 1
#endif
#endif

#if defined(MERLIN_ADDRESS_SANITIZER) || defined(MERLIN_THREAD_SANITIZER)
#define MERLIN_ANY_SANITIZER 1
#endif
