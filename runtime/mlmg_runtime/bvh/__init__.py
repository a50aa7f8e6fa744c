"""Reading and writing BVH files: `read(path)` and `write(bvh, path)`."""

from mlmg_runtime.bvh.document import Bvh, Joint
from mlmg_runtime.bvh.reading import read, read_bytes
from mlmg_runtime.bvh.writing import write, write_to

__all__ = ["Bvh", "Joint", "read", "read_bytes", "write", "write_to"]
