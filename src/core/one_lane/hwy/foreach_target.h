#pragma once

// Highway's header compiles the including file once for every instruction set. Here there is one, and nothing to do.
