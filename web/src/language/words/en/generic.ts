/** English: kinds of jobs without a folder of their own, drawn from the service's description. */

export const generic = {
  generic: {
    options: 'Options',
    start: 'Start',
    required: (input: string) => `Choose first: ${input}.`,
    file: {
      image: 'Drop a picture here',
      video: 'Drop a video here',
      motion: 'Drop a BVH, GLB or glTF file here',
    } as Record<string, string>,
    otherFile: 'Drop a file here',
    browse: 'or choose one',
    chosen: (input: string, name: string) => `${input}: ${name}. Choose another`,
    wrong: 'This is not a file of the right kind.',
    more: 'Add another file',
    removeWord: 'Remove',
    remove: (name: string) => `Remove ${name}`,
    named: 'Or by name',
    auto: 'The best match',
    none: 'None',
    usual: 'Default',
    yes: 'Yes',
    no: 'No',
    json: 'As JSON.',
    wrongJson: 'This is not valid JSON.',
    notOffered: 'This service makes nothing of this kind.',
    result: (kind: string) => `The result: ${kind}`,
    sharedTitle: (kind: string) => `A result: ${kind}`,
    model: 'The 3D model, to be turned',
  },
};
