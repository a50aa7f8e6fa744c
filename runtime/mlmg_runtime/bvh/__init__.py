"""Reading and writing BVH files: `read(path)` and `write(bvh, path)`."""
