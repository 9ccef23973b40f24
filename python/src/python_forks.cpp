// A run of an estimator that is not built in has a child process, which may be forked by a thread
// that does not hold the interpreter's lock. Whoever holds it then would hold it in the child for
// ever; so the thread that forks takes it first, as os.fork() does.

#include <pthread.h>

#include "python/src/python_estimator.hpp"

namespace fathom {
namespace {

// Of the thread that forks; absent where Python itself does, which sees to all this.
thread_local bool is_ours = false;
thread_local PyGILState_STATE state = PyGILState_UNLOCKED;

void before() {
  is_ours = Py_IsInitialized() != 0 && PyGILState_Check() == 0;
  if (!is_ours) return;
  state = PyGILState_Ensure();
  PyOS_BeforeFork();
}

void after_in_parent() {
  if (!is_ours) return;
  PyOS_AfterFork_Parent();
  PyGILState_Release(state);
}

void after_in_child() {
  if (!is_ours) return;
  PyOS_AfterFork_Child();
  // The thread keeps its state, the last one that there is: Python 3.11 cannot make another first.
  PyEval_SaveThread();
}

}  // namespace

void make_forks_safe() {
  static const int done = ::pthread_atfork(before, after_in_parent, after_in_child);
  (void)done;
}

}  // namespace fathom
