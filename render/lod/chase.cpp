#include "render/lod/chase.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace merlin::render::lod {
namespace {

void chasePortable(const Forest& forest, std::uint32_t alive, const std::uint32_t* from,
                   std::size_t count, std::uint32_t* out) {
  for (std::size_t i = 0; i < count; ++i) out[i] = forest.chase(from[i], alive);
}

#if defined(__x86_64__)
// The number of steps to an alive ancestor varies, so that branches of a loop over single corners
// are mispredicted. Here eight corners go up together until all are alive. REQUIRES: node numbers
// below 2^31.
__attribute__((target("avx2"))) void chaseAvx2(const Forest& forest, std::uint32_t alive,
                                               const std::uint32_t* from, std::size_t count,
                                               std::uint32_t* out) {
  const int* parents = reinterpret_cast<const int*>(forest.parents.data());
  const __m256i below = _mm256_set1_epi32(static_cast<int>(alive) - 1);
  const __m256i last = _mm256_set1_epi32(static_cast<int>(forest.nodes) - 1);
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8) {
    __m256i node = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from + i));
    __m256i dead = _mm256_cmpgt_epi32(node, below);
    while (_mm256_movemask_epi8(dead) != 0) {
      const __m256i at = _mm256_srli_epi32(_mm256_sub_epi32(last, node), 1);
      node = _mm256_mask_i32gather_epi32(node, parents, at, dead, 4);
      dead = _mm256_cmpgt_epi32(node, below);
    }
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(out + i), node);
  }
  chasePortable(forest, alive, from + i, count - i, out + i);
}
#endif

}  // namespace

ChaseAll portableChaser() { return chasePortable; }

ChaseAll chaser(std::size_t nodes) {
#if defined(__x86_64__)
  if (nodes <= (std::size_t{1} << 31) && __builtin_cpu_supports("avx2")) return chaseAvx2;
#endif
  return chasePortable;
}

}  // namespace merlin::render::lod
