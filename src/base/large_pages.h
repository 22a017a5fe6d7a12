/* large_pages.h - the heap of this process in pages of 2 MiB. */
#ifndef BASE_LARGE_PAGES_H
#define BASE_LARGE_PAGES_H

enum { LARGE_PAGE = 1 << 21 }; /* bytes, of x86-64 and aarch64 */

/* large_pages_for_heap: to be called once, before any other thread is there: what the heap holds
 * from then on lies in pages of 2 MiB where the system gives them to who asks, and stays with the
 * process when it is freed, up to 64 MiB. A page costs a fault each time it comes and goes, the
 * small ones as much as the large. Without glibc, with a sanitizer's heap, with less than 4 GiB
 * (size_available), or where the system refuses: nothing. */
void large_pages_for_heap(void);

#endif
