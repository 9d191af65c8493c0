// SCREE_SHADOW_MEMORY: built with a sanitizer whose own memory takes the address space, so that it cannot be limited.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SCREE_SHADOW_MEMORY
#endif
#endif
