// Tells thread sanitizer where TBB hands work from thread to thread.
//
// The TBB library is not instrumented, so the sanitizer sees neither that a task starts after it
// was spawned nor that a loop's caller goes on after its tasks. It would call every parallel loop a
// race. Suppressing what TBB has on its stack (`race:libtbb`) hides all of our own races: every
// task is started by TBB. Instead the few entry points through which TBB's headers hand work to the
// library stand here once more, say "happens before" and call the library.
//
// This file is compiled without the sanitizer: what it does to keep its books orders nothing.
#include <dlfcn.h>
#include <oneapi/tbb/detail/_small_object_pool.h>
#include <oneapi/tbb/detail/_task.h>
#include <sanitizer/tsan_interface.h>

#include <cstdio>
#include <cstdlib>

namespace tbb::detail {
namespace {

/// The library's own function of a mangled name.
template <class Function>
Function* in_library(const char* name) {
  void* const found = dlsym(RTLD_NEXT, name);
  if (found == nullptr) {
    std::fprintf(stderr, "this TBB has no %s\n", name);
    std::abort();
  }
  return reinterpret_cast<Function*>(found);
}

/// Stands in for a spawned task: whichever thread takes it goes on from where it was spawned.
class Handover final : public d1::task {
 public:
  explicit Handover(d1::task& spawned) : spawned_(spawned) { __tsan_release(&spawned_); }
  d1::task* execute(d1::execution_data& data) override {
    return run([&] { return spawned_.execute(data); });
  }
  d1::task* cancel(d1::execution_data& data) override {
    return run([&] { return spawned_.cancel(data); });
  }

 private:
  /// What throws is not done: the library then calls cancel().
  template <class Work>
  d1::task* run(Work&& work) {
    __tsan_acquire(&spawned_);
    d1::task* const next = work();
    delete this;
    return next;
  }
  d1::task& spawned_;
};

/// At its end the caller goes on from where the last task left the count, also if one of them
/// threw.
class Join {
 public:
  explicit Join(d1::wait_context& tasks) : tasks_(tasks) {}
  Join(const Join&) = delete;
  Join& operator=(const Join&) = delete;
  ~Join() {
    // The count, which the headers lower in instrumented code, is the second of two words.
    static_assert(sizeof(d1::wait_context) == 2 * sizeof(std::uint64_t));
    __tsan_acquire(reinterpret_cast<char*>(&tasks_) + sizeof(std::uint64_t));
  }

 private:
  d1::wait_context& tasks_;
};

}  // namespace

namespace r1 {

void spawn(d1::task& task, d1::task_group_context& context) {
  static auto* const library = in_library<void(d1::task&, d1::task_group_context&)>(
      "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
  library(*new Handover(task), context);
}

void spawn(d1::task& task, d1::task_group_context& context, d1::slot_id slot) {
  static auto* const library = in_library<void(d1::task&, d1::task_group_context&, d1::slot_id)>(
      "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
  library(*new Handover(task), context, slot);
}

void execute_and_wait(d1::task& task, d1::task_group_context& context, d1::wait_context& tasks,
                      d1::task_group_context& waiting) {
  static auto* const library = in_library<void(d1::task&, d1::task_group_context&,
                                               d1::wait_context&, d1::task_group_context&)>(
      "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextE"
      "RNS2_12wait_contextES6_");
  const Join join(tasks);
  library(task, context, tasks, waiting);
}

void wait(d1::wait_context& tasks, d1::task_group_context& context) {
  static auto* const library = in_library<void(d1::wait_context&, d1::task_group_context&)>(
      "_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE");
  const Join join(tasks);
  library(tasks, context);
}

// Small objects: what one thread gives back another one may get.

void* allocate(d1::small_object_pool*& pool, std::size_t bytes, const d1::execution_data& data) {
  static auto* const library =
      in_library<void*(d1::small_object_pool*&, std::size_t, const d1::execution_data&)>(
          "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEmRKNS2_14execution_dataE");
  void* const object = library(pool, bytes, data);
  __tsan_acquire(object);
  return object;
}

void* allocate(d1::small_object_pool*& pool, std::size_t bytes) {
  static auto* const library = in_library<void*(d1::small_object_pool*&, std::size_t)>(
      "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEm");
  void* const object = library(pool, bytes);
  __tsan_acquire(object);
  return object;
}

void deallocate(d1::small_object_pool& pool, void* object, std::size_t bytes,
                const d1::execution_data& data) {
  static auto* const library =
      in_library<void(d1::small_object_pool&, void*, std::size_t, const d1::execution_data&)>(
          "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvmRKNS2_14execution_dataE");
  __tsan_release(object);
  library(pool, object, bytes, data);
}

void deallocate(d1::small_object_pool& pool, void* object, std::size_t bytes) {
  static auto* const library = in_library<void(d1::small_object_pool&, void*, std::size_t)>(
      "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvm");
  __tsan_release(object);
  library(pool, object, bytes);
}

}  // namespace r1
}  // namespace tbb::detail
