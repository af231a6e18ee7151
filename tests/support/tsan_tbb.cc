// Shows oneTBB's synchronisation to the thread sanitizer; linked into the programs of a tsan build
// only.
//
// Debian's libtbb is not instrumented, so the sanitizer sees neither that a task starts after it
// was spawned nor that a wait ends after the tasks did, and takes every correct parallel_for for a
// race. Suppressions by name would hide true races of ours with it: their stacks are the same. So
// the few entries of libtbb through which all of its algorithms go are put in front of the
// library's own here, each with the happens-before edge that oneTBB's specification promises, and
// no edge more: tasks that are siblings stay unordered (tests/support/seeded_race.cc makes sure of
// it).

#include <dlfcn.h>
#include <oneapi/tbb/detail/_small_object_pool.h>
#include <oneapi/tbb/detail/_task.h>
#include <sanitizer/tsan_interface.h>

#include <cstdint>
#include <cstdlib>

/// What remains is memory that libtbb frees in one of its threads after another has read it, with
/// no code of ours in between: its calls of operator delete and the like are left out. What tasks
/// do is not, since they are not the library's code.
extern "C" const char* __tsan_default_suppressions() {  // NOLINT: the sanitizer's name
  return "called_from_lib:libtbb.so\n";
}

namespace {

using namespace tbb::detail;  // NOLINT(google-build-using-namespace)

/// libtbb's own function of that (mangled) name.
template <class Function>
Function library_function(const char* name) {
  void* address = dlsym(RTLD_NEXT, name);
  if (address == nullptr) std::abort();  // another libtbb than Debian 12's
  return reinterpret_cast<Function>(address);
}

/// Stands for a spawned task: orders the spawn before the execution.
class OrderedTask final : public d1::task {
 public:
  explicit OrderedTask(d1::task& task) : task_(&task) { __tsan_release(this); }

  d1::task* execute(d1::execution_data& data) override {
    __tsan_acquire(this);
    d1::task* const next = task_->execute(data);
    delete this;
    return next;
  }
  // Also called after execute() has thrown, so nothing was deleted there.
  d1::task* cancel(d1::execution_data& data) override {
    __tsan_acquire(this);
    d1::task* const next = task_->cancel(data);
    delete this;
    return next;
  }

 private:
  d1::task* task_;
};

/// A task's end is an atomic decrement of the wait context's counter, in oneTBB's headers and so
/// visible already. What is missing is its reader, inside the library, which reads before it
/// returns or throws on what a task threw: the counter follows one other member.
class EndsOfTasks {
 public:
  explicit EndsOfTasks(d1::wait_context& wait_context)
      : counter_(reinterpret_cast<std::uint64_t*>(&wait_context) + 1) {
    static_assert(sizeof(d1::wait_context) == 2 * sizeof(std::uint64_t));
  }
  ~EndsOfTasks() { __tsan_acquire(counter_); }
  EndsOfTasks(const EndsOfTasks&) = delete;
  EndsOfTasks& operator=(const EndsOfTasks&) = delete;

 private:
  std::uint64_t* counter_;
};

}  // namespace

namespace tbb::detail::r1 {

void __TBB_EXPORTED_FUNC spawn(d1::task& task, d1::task_group_context& context) {
  static const auto library = library_function<void (*)(d1::task&, d1::task_group_context&)>(
      "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextE");
  library(*new OrderedTask(task), context);
}

void __TBB_EXPORTED_FUNC spawn(d1::task& task, d1::task_group_context& context, d1::slot_id slot) {
  static const auto library =
      library_function<void (*)(d1::task&, d1::task_group_context&, d1::slot_id)>(
          "_ZN3tbb6detail2r15spawnERNS0_2d14taskERNS2_18task_group_contextEt");
  library(*new OrderedTask(task), context, slot);
}

void __TBB_EXPORTED_FUNC execute_and_wait(d1::task& task, d1::task_group_context& task_context,
                                          d1::wait_context& wait_context,
                                          d1::task_group_context& context) {
  static const auto library = library_function<void (*)(
      d1::task&, d1::task_group_context&, d1::wait_context&, d1::task_group_context&)>(
      "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_12wait_"
      "contextES6_");
  const EndsOfTasks acquired(wait_context);
  library(task, task_context, wait_context, context);
}

void __TBB_EXPORTED_FUNC wait(d1::wait_context& wait_context, d1::task_group_context& context) {
  static const auto library =
      library_function<void (*)(d1::wait_context&, d1::task_group_context&)>(
          "_ZN3tbb6detail2r14waitERNS0_2d112wait_contextERNS2_18task_group_contextE");
  const EndsOfTasks acquired(wait_context);
  library(wait_context, context);
}

// Memory of tasks goes from thread to thread through a pool.
void* __TBB_EXPORTED_FUNC allocate(d1::small_object_pool*& pool, std::size_t bytes,
                                   const d1::execution_data& data) {
  static const auto library =
      library_function<void* (*)(d1::small_object_pool*&, std::size_t, const d1::execution_data&)>(
          "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEmRKNS2_14execution_dataE");
  void* const memory = library(pool, bytes, data);
  __tsan_acquire(memory);
  return memory;
}

void* __TBB_EXPORTED_FUNC allocate(d1::small_object_pool*& pool, std::size_t bytes) {
  static const auto library = library_function<void* (*)(d1::small_object_pool*&, std::size_t)>(
      "_ZN3tbb6detail2r18allocateERPNS0_2d117small_object_poolEm");
  void* const memory = library(pool, bytes);
  __tsan_acquire(memory);
  return memory;
}

void __TBB_EXPORTED_FUNC deallocate(d1::small_object_pool& pool, void* memory, std::size_t bytes,
                                    const d1::execution_data& data) {
  static const auto library = library_function<void (*)(d1::small_object_pool&, void*, std::size_t,
                                                        const d1::execution_data&)>(
      "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvmRKNS2_14execution_dataE");
  __tsan_release(memory);
  library(pool, memory, bytes, data);
}

void __TBB_EXPORTED_FUNC deallocate(d1::small_object_pool& pool, void* memory, std::size_t bytes) {
  static const auto library =
      library_function<void (*)(d1::small_object_pool&, void*, std::size_t)>(
          "_ZN3tbb6detail2r110deallocateERNS0_2d117small_object_poolEPvm");
  __tsan_release(memory);
  library(pool, memory, bytes);
}

}  // namespace tbb::detail::r1
