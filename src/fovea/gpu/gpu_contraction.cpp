#include "fovea/gpu/gpu_contraction.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "fovea/gpu/gl_objects.h"
#include "fovea/gpu/gpu_context.h"

namespace fovea {

namespace {

constexpr std::size_t kGroup = 256;         // invocations together; also triangles in a block
constexpr std::size_t kMostGroups = 65535;  // of a dispatch

/// Each node to its parent, if the step between them is taken; else it is its own target.
constexpr const char* kStart = R"(#version 430
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer Taken { uint taken[]; };
layout(std430, binding = 1) readonly buffer Parent { uint parent[]; };
layout(std430, binding = 2) readonly buffer Step { uint step_of[]; };
layout(std430, binding = 3) writeonly buffer Target { uint next[]; };
uniform uint first, end;
void main() {
  uint i = first + gl_GlobalInvocationID.x;
  if (i >= end) return;
  uint s = step_of[i];
  bool goes = s != 0xFFFFFFFFu && (taken[s >> 5] >> (s & 31u) & 1u) != 0u;
  next[i] = goes ? parent[i] : i;
}
)";

/// Twice as far along the chain.
constexpr const char* kJump = R"(#version 430
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer From { uint from[]; };
layout(std430, binding = 1) writeonly buffer To { uint to[]; };
uniform uint first, end;
void main() {
  uint i = first + gl_GlobalInvocationID.x;
  if (i >= end) return;
  to[i] = from[from[i]];
}
)";

/// How many triangles of each block are left. A block is its first triangle, the one after its last, and the
/// first block of its part.
constexpr const char* kCount = R"(#version 430
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer Taken { uint taken[]; };
layout(std430, binding = 1) readonly buffer Removed { uint removed_by[]; };
layout(std430, binding = 2) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) writeonly buffer Counts { uint counts[]; };
uniform uint first;
shared uint left;
void main() {
  uint block = first + gl_WorkGroupID.x;
  if (gl_LocalInvocationIndex == 0u) left = 0u;
  barrier();
  uint f = blocks[3u * block] + gl_LocalInvocationIndex;
  if (f < blocks[3u * block + 1u]) {
    uint s = removed_by[f];
    if (s == 0xFFFFFFFFu || (taken[s >> 5] >> (s & 31u) & 1u) == 0u) atomicAdd(left, 1u);
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u) counts[block] = left;
}
)";

/// Counts to what is before each block, over all parts; one group. Then what each part draws.
constexpr const char* kAddUp = R"(#version 430
layout(local_size_x = 256) in;
layout(std430, binding = 0) buffer Counts { uint counts[]; };
layout(std430, binding = 1) readonly buffer Parts { uint parts[]; };
layout(std430, binding = 2) writeonly buffer Draws { uint draws[]; };
uniform uint block_count, part_count;
shared uint sums[256];
void main() {
  uint lane = gl_LocalInvocationIndex, before = 0u;
  for (uint begin = 0u; begin < block_count; begin += 256u) {
    uint block = begin + lane;
    uint own = block < block_count ? counts[block] : 0u;
    sums[lane] = own;
    barrier();
    for (uint reach = 1u; reach < 256u; reach <<= 1) {
      uint other = lane >= reach ? sums[lane - reach] : 0u;
      barrier();
      sums[lane] += other;
      barrier();
    }
    if (block < block_count) counts[block] = before + sums[lane] - own;
    before += sums[255];
    barrier();
  }
  if (lane == 0u) counts[block_count] = before;
  barrier();
  memoryBarrierBuffer();
  for (uint p = lane; p < part_count; p += 256u) {
    draws[5u * p] = 3u * (counts[parts[3u * p + 2u]] - counts[parts[3u * p + 1u]]);
    draws[5u * p + 1u] = 1u;
    draws[5u * p + 2u] = 3u * parts[3u * p];
    draws[5u * p + 3u] = 0u;
    draws[5u * p + 4u] = 0u;
  }
}
)";

/// The corners of the triangles that are left, in order.
constexpr const char* kWrite = R"(#version 430
layout(local_size_x = 256) in;
layout(std430, binding = 0) readonly buffer Taken { uint taken[]; };
layout(std430, binding = 1) readonly buffer Removed { uint removed_by[]; };
layout(std430, binding = 2) readonly buffer Blocks { uint blocks[]; };
layout(std430, binding = 3) readonly buffer Counts { uint counts[]; };
layout(std430, binding = 4) readonly buffer Corners { uint corners[]; };
layout(std430, binding = 5) readonly buffer Target { uint next[]; };
layout(std430, binding = 6) readonly buffer Vertex { uint vertex[]; };
layout(std430, binding = 7) writeonly buffer Indices { uint indices[]; };
uniform uint first;
shared uint ranks[256];
void main() {
  uint block = first + gl_WorkGroupID.x, lane = gl_LocalInvocationIndex;
  uint f = blocks[3u * block] + lane;
  bool there = false;
  if (f < blocks[3u * block + 1u]) {
    uint s = removed_by[f];
    there = s == 0xFFFFFFFFu || (taken[s >> 5] >> (s & 31u) & 1u) == 0u;
  }
  ranks[lane] = there ? 1u : 0u;
  barrier();
  for (uint reach = 1u; reach < 256u; reach <<= 1) {
    uint other = lane >= reach ? ranks[lane - reach] : 0u;
    barrier();
    ranks[lane] += other;
    barrier();
  }
  if (!there) return;
  uint first_block = blocks[3u * block + 2u];
  uint at = 3u * (blocks[3u * first_block] + counts[block] - counts[first_block] + ranks[lane] - 1u);
  for (uint k = 0u; k < 3u; ++k) indices[at + k] = vertex[next[corners[3u * f + k]]];
}
)";

GlProgram compute(const char* source) { return GlProgram({{GL_COMPUTE_SHADER, source}}); }

/// A command of glDrawElementsIndirect.
struct Draw {
  std::uint32_t count = 0, instances = 1, first_index = 0;
  std::int32_t base_vertex = 0;
  std::uint32_t base_instance = 0;
};

/// Bindings that a program may have made and that are used here.
class KeepBindings {
 public:
  KeepBindings() {
    glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
    for (GLuint i = 0; i < buffers_.size(); ++i)
      glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &buffers_[i]);
  }
  ~KeepBindings() {
    for (GLuint i = 0; i < buffers_.size(); ++i)
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, i, static_cast<GLuint>(buffers_[i]));
    glUseProgram(static_cast<GLuint>(program_));
  }
  KeepBindings(const KeepBindings&) = delete;
  KeepBindings& operator=(const KeepBindings&) = delete;

 private:
  GLint program_ = 0;
  std::array<GLint, 8> buffers_{};
};

void wait_for_writes() { glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT); }

}  // namespace

/// What is on the card, and the passes over it.
struct GpuContraction::Card {
  explicit Card(const VertexHierarchy& hierarchy);

  /// Work of a kind: nodes, or blocks of triangles.
  enum class Pass { start, jump, count, add_up, write };
  struct Stage {
    Pass pass;
    std::size_t size;
  };
  void run(std::size_t stage, std::size_t begin, std::size_t end, std::size_t level);
  void run_nodes(const GlProgram& program, std::size_t begin, std::size_t end);
  void run_blocks(const GlProgram& program, std::size_t begin, std::size_t end);

  GlProgram start = compute(kStart), jump = compute(kJump), count = compute(kCount), add_up = compute(kAddUp),
            write = compute(kWrite);
  std::vector<Stage> stages;
  std::size_t block_count = 0, part_count = 0;
  GlBuffer taken, parent, step, vertex, corners, removed_by, blocks, parts, counts;
  std::array<GlBuffer, 2> next;            ///< Targets before and after a jump.
  std::array<GlBuffer, 2> indices, draws;  ///< Of the level shown and the one in hand.
};

GpuContraction::Card::Card(const VertexHierarchy& hierarchy)
    : parent(hierarchy.parent),
      step(hierarchy.step),
      vertex(hierarchy.vertex),
      corners(hierarchy.corners),
      removed_by(hierarchy.removed_by) {
  taken = GlBuffer(StepBits(hierarchy.step_count).words().size_bytes());

  std::vector<std::uint32_t> block_list, part_list;
  for (const LevelPart& part : hierarchy.parts) {
    const auto first = static_cast<std::uint32_t>(block_list.size() / 3);
    for (std::uint32_t f = part.first_face; f < part.end_face; f += kGroup)
      block_list.insert(block_list.end(), {f, std::min<std::uint32_t>(f + kGroup, part.end_face), first});
    part_list.insert(part_list.end(),
                     {part.first_face, first, static_cast<std::uint32_t>(block_list.size() / 3)});
  }
  block_count = block_list.size() / 3;
  part_count = hierarchy.parts.size();
  blocks = GlBuffer(block_list);
  parts = GlBuffer(part_list);
  counts = GlBuffer(4 * (block_count + 1));
  const std::vector<Draw> nothing(part_count);
  for (std::size_t i = 0; i < 2; ++i) {
    next[i] = GlBuffer(4 * hierarchy.node_count());
    indices[i] = GlBuffer(12 * hierarchy.face_count());
    draws[i] = GlBuffer(nothing);
  }

  stages.push_back({Pass::start, hierarchy.node_count()});
  const int jumps = hierarchy.depth > 1 ? std::bit_width(hierarchy.depth - 1) : 0;
  for (int i = 0; i < jumps; ++i) stages.push_back({Pass::jump, hierarchy.node_count()});
  stages.push_back({Pass::count, block_count});
  stages.push_back({Pass::add_up, 1});
  stages.push_back({Pass::write, block_count});
}

void GpuContraction::Card::run(std::size_t stage, std::size_t begin, std::size_t end, std::size_t level) {
  switch (stages[stage].pass) {
    case Pass::start:
      taken.bind(0);
      parent.bind(1);
      step.bind(2);
      next[0].bind(3);
      run_nodes(start, begin, end);
      break;
    case Pass::jump:  // the first is stage 1
      next[(stage - 1) % 2].bind(0);
      next[stage % 2].bind(1);
      run_nodes(jump, begin, end);
      break;
    case Pass::count:
      taken.bind(0);
      removed_by.bind(1);
      blocks.bind(2);
      counts.bind(3);
      run_blocks(count, begin, end);
      break;
    case Pass::add_up:
      counts.bind(0);
      parts.bind(1);
      draws[level].bind(2);
      add_up.use();
      glUniform1ui(add_up.uniform("block_count"), static_cast<GLuint>(block_count));
      glUniform1ui(add_up.uniform("part_count"), static_cast<GLuint>(part_count));
      glDispatchCompute(1, 1, 1);
      break;
    case Pass::write:
      taken.bind(0);
      removed_by.bind(1);
      blocks.bind(2);
      counts.bind(3);
      corners.bind(4);
      next[(stages.size() - 4) % 2].bind(5);  // after so many jumps
      vertex.bind(6);
      indices[level].bind(7);
      run_blocks(write, begin, end);
      break;
  }
}

void GpuContraction::Card::run_nodes(const GlProgram& program, std::size_t begin, std::size_t end) {
  program.use();
  glUniform1ui(program.uniform("end"), static_cast<GLuint>(end));
  for (std::size_t first = begin; first < end; first += kMostGroups * kGroup) {
    const std::size_t groups = std::min(kMostGroups, (end - first + kGroup - 1) / kGroup);
    glUniform1ui(program.uniform("first"), static_cast<GLuint>(first));
    glDispatchCompute(static_cast<GLuint>(groups), 1, 1);
  }
}

void GpuContraction::Card::run_blocks(const GlProgram& program, std::size_t begin, std::size_t end) {
  program.use();
  for (std::size_t first = begin; first < end; first += kMostGroups) {
    glUniform1ui(program.uniform("first"), static_cast<GLuint>(first));
    glDispatchCompute(static_cast<GLuint>(std::min(kMostGroups, end - first)), 1, 1);
  }
}

GpuContraction::GpuContraction(const VertexHierarchy& hierarchy) : hierarchy_(hierarchy) {
  need_gpu_context();
  const KeepBindings keep;
  card_ = std::make_unique<Card>(hierarchy);
}

GpuContraction::~GpuContraction() = default;

std::size_t GpuContraction::total_work() const {
  std::size_t sum = 0;
  for (const Card::Stage& stage : card_->stages) sum += stage.size;
  return sum;
}

void GpuContraction::begin(const StepBits& taken) {
  card_->taken.set(std::as_bytes(taken.words()));
  done_ = 0;
}

bool GpuContraction::advance(std::size_t work) {
  const KeepBindings keep;
  const std::size_t total = total_work();
  const std::size_t end = work < total - done_ ? done_ + work : total;
  std::size_t first = 0;
  for (std::size_t i = 0; i < card_->stages.size() && first < end; ++i) {
    const std::size_t size = card_->stages[i].size;
    if (done_ < first + size) {
      const std::size_t last = std::min(end, first + size);
      card_->run(i, done_ - first, last - first, 1 - shown_);
      done_ = last;
      if (last == first + size) wait_for_writes();
    }
    first += size;
  }
  if (done_ < total) return false;
  shown_ = 1 - shown_;
  glMemoryBarrier(GL_ELEMENT_ARRAY_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  return true;
}

unsigned GpuContraction::index_buffer() const { return card_->indices[shown_].name(); }

unsigned GpuContraction::draw_buffer() const { return card_->draws[shown_].name(); }

LevelIndices GpuContraction::read_back() const {
  LevelIndices level;
  level.indices.resize(3 * hierarchy_.face_count());
  std::vector<Draw> draws(hierarchy_.parts.size());
  card_->indices[shown_].get(std::as_writable_bytes(std::span(level.indices)));
  card_->draws[shown_].get(std::as_writable_bytes(std::span(draws)));
  for (const Draw& draw : draws) level.triangles.push_back(draw.count / 3);
  return level;
}

}  // namespace fovea
